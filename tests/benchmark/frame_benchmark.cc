// SPDX-License-Identifier: MIT
// The time of a frame and of its parts. RESULTS.md has the figures.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <vector>

#include "common/fit/posture_fit.h"
#include "common/math/rotation.h"
#include "common/model/marker_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "plugins/s2kf/lcd_sampling.h"
#include "plugins/s2kf/marker_measurement_model.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/long_recording.h"

namespace mmm_converter::s2kf {
namespace {

constexpr double kFrameTime = 0.01;
constexpr int kSettled = 60;  // frames; the first ones look for better postures

/// The handstand of the examples, with as many joints and markers as asked for.
struct Task {
  Task(int num_joints, int num_markers)
      : model(ScaledReferenceModel(1.8)), joints(Joints(model, num_joints)) {
    markers = SynthesizeMarkers(model, MakeHandstand(model), MarkerErrors{}, 1);
    assignments = AssignAll(model, markers);
    assignments.resize(std::min<std::size_t>(num_markers, assignments.size()));
    kinematics = std::make_unique<MarkerKinematics>(model, joints, MarkerIndices(assignments));
  }

  TrackingSetup Setup() const { return SetupOf(model, joints, assignments); }

  /// The paper's 40, or the first so many of the whole body with its fingers.
  static std::vector<int> Joints(const KinematicModel& model, int count) {
    if (count == 40) return MotionJoints(model, 40);
    std::vector<int> joints = MotionJoints(model, 44);
    for (int j = 0; j < model.num_joints(); ++j) {
      if (std::find(joints.begin(), joints.end(), j) == joints.end()) joints.push_back(j);
    }
    joints.resize(std::min<std::size_t>(count, joints.size()));
    return joints;
  }

  /// The frames after the start, back and forth.
  int FrameAt(int step) const {
    return kSettled + FrameBackAndForth(step, markers.num_frames() - kSettled);
  }

  KinematicModel model;
  std::vector<int> joints;
  MarkerSequence markers;
  std::vector<MarkerAssignment> assignments;
  std::unique_ptr<MarkerKinematics> kinematics;
};

constexpr int kJoints = 40;
constexpr int kMarkers = 50;

void ForwardKinematics(benchmark::State& state) {
  const Task task(static_cast<int>(state.range(1)), kMarkers);
  MarkerBatch batch = task.kinematics->MakeBatch(static_cast<int>(state.range(0)));
  batch.rotation.view().col(0).setOnes();
  batch.rotation.view().col(4).setOnes();
  batch.rotation.view().col(8).setOnes();
  for (int j = 0; j < batch.angles.cols(); ++j) {
    batch.angles.view().col(j).setLinSpaced(task.kinematics->lower()[j],
                                            task.kinematics->upper()[j]);
  }
  for (auto _ : state) {
    task.kinematics->ComputeBatch(&batch);
    benchmark::DoNotOptimize(batch.markers.data());
  }
}

void RunFrames(benchmark::State& state, const S2kfSettings& settings, const Task& task) {
  S2kfConverter converter(task.Setup(), settings);
  converter.Assemble(task.markers.frame(0));
  for (int k = 1; k < kSettled; ++k) converter.Track(task.markers.frame(k), kFrameTime);
  int step = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(converter.Track(task.markers.frame(task.FrameAt(step++)), kFrameTime));
  }
}

void S2kfFrame(benchmark::State& state, UpdateForm form) {
  S2kfSettings settings;
  settings.samples = static_cast<int>(state.range(0));
  settings.update = form;
  RunFrames(state, settings,
            Task(static_cast<int>(state.range(1)) - 6, static_cast<int>(state.range(2))));
}

/// One update a frame and no search, so that only the sizes differ.
void S2kfUpdate(benchmark::State& state) {
  S2kfSettings settings;
  settings.samples = static_cast<int>(state.range(0));
  settings.iterations = 1;
  settings.recovery = false;
  RunFrames(state, settings,
            Task(static_cast<int>(state.range(1)) - 6, static_cast<int>(state.range(2))));
}

void FilterFrame(benchmark::State& state, FilterType filter) {
  S2kfSettings settings;
  settings.filter = filter;
  RunFrames(state, settings, Task(static_cast<int>(state.range(0)) - 6, kMarkers));
}

void LeastSquaresFrame(benchmark::State& state) {
  const Task task(static_cast<int>(state.range(0)) - 6, kMarkers);
  PostureFit fit(*task.kinematics);
  PostureSearch search(*task.kinematics);
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(task.kinematics->num_markers());
  const PostureFitOptions options;
  Posture posture;
  const auto frame = [&](int k) { return task.markers.frame(k).leftCols(kMarkers); };
  search.Assemble(frame(kSettled), scale, options, 4, &posture);
  int step = 0;
  double iterations = 0;
  for (auto _ : state) {
    iterations += fit.Solve(frame(task.FrameAt(step++)), scale, options, &posture).iterations;
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}

void Start(benchmark::State& state) {
  const Task task(kJoints, kMarkers);
  S2kfConverter converter(task.Setup(), S2kfSettings{});
  for (auto _ : state) benchmark::DoNotOptimize(converter.Assemble(task.markers.frame(0)));
}

void AsInThePaper(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMicrosecond)->Args({301, 46, kMarkers});
}

// Cost over samples, markers, and degrees of freedom (with fingers).
void Curves(benchmark::internal::Benchmark* benchmark) {
  benchmark->Unit(benchmark::kMicrosecond);
  for (const int samples : {93, 201, 301, 501, 1001}) benchmark->Args({samples, 46, kMarkers});
  for (const int markers : {20, 30, 40, 53}) benchmark->Args({301, 46, markers});
  for (const int dofs : {20, 30, 60, 80, 106}) benchmark->Args({301, dofs, kMarkers});
}

BENCHMARK(ForwardKinematics)->Args({301, kJoints})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(S2kfFrame, regression, UpdateForm::kRegression)->Apply(AsInThePaper);
BENCHMARK_CAPTURE(S2kfFrame, exact, UpdateForm::kExact)->Apply(AsInThePaper);
BENCHMARK_CAPTURE(FilterFrame, ukf, FilterType::kUkf)->Arg(46)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(FilterFrame, ekf, FilterType::kEkf)->Arg(46)->Unit(benchmark::kMicrosecond);
BENCHMARK(LeastSquaresFrame)->Arg(46)->Unit(benchmark::kMicrosecond);
BENCHMARK(Start)->Unit(benchmark::kMicrosecond);
BENCHMARK(S2kfUpdate)->Apply(Curves);

}  // namespace
}  // namespace mmm_converter::s2kf
