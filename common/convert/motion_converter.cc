// SPDX-License-Identifier: MIT
#include "common/convert/motion_converter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/convert/checked_converter.h"
#include "common/model/posture.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

int CountSeen(const MarkerSequence& recording, const TrackingSetup& setup, int frame) {
  const auto points = recording.frame(frame);
  const std::vector<MarkerAssignment>& assignments = setup.assignments();
  return static_cast<int>(std::count_if(
      assignments.begin(), assignments.end(),
      [&](const MarkerAssignment& assignment) { return IsSeen(points.col(assignment.label)); }));
}

// Where tracking begins.
struct FirstFrames {
  int seen = -1;       // shows three markers
  int assembled = -1;  // shows most of the body
};

// A posture can be assembled where a third of the markers are seen, or, where that is not soon, as
// many as in any frame of the second after the first three. Who comes late is there in part at
// first.
FirstFrames FindFirstFrames(const MarkerSequence& recording, const TrackingSetup& setup) {
  const int enough = std::max(kFewestMarkers, static_cast<int>(setup.assignments().size()) / 3);
  const int second = std::max(1, static_cast<int>(std::ceil(recording.rate())));
  int end = recording.num_frames();
  FirstFrames first;
  int most = 0;
  for (int k = 0; k < end; ++k) {
    const int seen = CountSeen(recording, setup, k);
    if (seen <= most) continue;
    most = seen;
    if (seen < kFewestMarkers) continue;
    if (first.seen < 0) {
      first.seen = k;
      end = std::min(end, k + second);
    }
    first.assembled = k;
    if (seen >= enough) break;
  }
  if (first.seen >= 0) return first;
  throw Error(
      fmt::format("no frame shows {} mapped markers (at most {} of {} are seen); check the "
                  "marker mapping",
                  kFewestMarkers, most, setup.assignments().size()));
}

// Whether three markers are where the posture has them.
bool IsTracked(const FrameEstimate& estimate) {
  return estimate.converged && !estimate.reassembled &&
         estimate.markers_seen - estimate.markers_wrong >= kFewestMarkers;
}

// Fills one frame of a result from what a converter says of it.
class ResultWriter {
 public:
  ResultWriter(const MarkerSequence& recording, const TrackingSetup& setup)
      : recording_(recording), setup_(setup) {
    const int frames = recording.num_frames();
    const int assignments = static_cast<int>(setup.assignments().size());
    const std::vector<int>& joints = setup.joints;
    PoseTrajectory& trajectory = result_.trajectory;
    trajectory.rate = recording.rate();
    trajectory.first_time = recording.first_time();
    for (const int joint : joints) trajectory.joint_names.push_back(setup.model->joint(joint).name);
    trajectory.postures.resize(frames);
    trajectory.standard_deviations.setConstant(6 + static_cast<int>(joints.size()), frames, kNaN);
    result_.residuals.setConstant(assignments, frames, kNaN);
    result_.frames.resize(frames);
    verdicts_.setConstant(assignments, frames, kAsLabelled);
  }

  void WritePosture(int k, const FrameEstimate& estimate) {
    Posture& posture = result_.trajectory.postures[k];
    posture.position = estimate.posture.position;
    posture.orientation = estimate.posture.orientation;
    posture.joint_angles = estimate.posture.joint_angles(setup_.joints);
    if (estimate.standard_deviations.size() > 0) {
      auto deviations = result_.trajectory.standard_deviations.col(k);
      deviations.head<6>() = estimate.standard_deviations.head<6>();
      const auto of_joints =
          estimate.standard_deviations.tail(estimate.standard_deviations.size() - 6);
      deviations.tail(static_cast<int>(setup_.joints.size())) = of_joints(setup_.joints);
    }
  }

  void Write(int k, const FrameEstimate& estimate, double seconds) {
    WritePosture(k, estimate);
    result_.residuals.col(k) = estimate.residuals;
    result_.frames[k] = {estimate.markers_seen,
                         estimate.markers_downweighted,
                         estimate.markers_wrong,
                         estimate.nis,
                         estimate.reassembled,
                         estimate.converged,
                         seconds};
    if (estimate.verdicts.size() > 0) verdicts_.col(k) = estimate.verdicts;
  }

  // Frames before the body is there take its first posture, which is not theirs.
  void WriteEarlier(int first) {
    PoseTrajectory& trajectory = result_.trajectory;
    for (int k = 0; k < first; ++k) {
      trajectory.postures[k] = trajectory.postures[first];
      trajectory.standard_deviations.col(k) = trajectory.standard_deviations.col(first);
      result_.frames[k].markers_seen = CountSeen(recording_, setup_, k);
    }
  }

  ConversionResult Finish() {
    result_.incidents = FindIncidents(verdicts_, BridgedFrames(recording_.rate()));
    return std::move(result_);
  }

 private:
  const MarkerSequence& recording_;
  const TrackingSetup& setup_;
  Eigen::MatrixXi verdicts_;  // assignments x frames
  ConversionResult result_;
};

}  // namespace

MotionConverter::MotionConverter(TrackingSetup setup) : setup_(std::move(setup)) {}
MotionConverter::~MotionConverter() = default;
void MotionConverter::Prepare(double /*dt*/) {}
bool MotionConverter::KeepCovariances() { return false; }
MotionConverterFactory::~MotionConverterFactory() = default;

ConversionResult MotionConverter::Convert(const MarkerSequence& recording,
                                          const std::function<bool(int)>& progress) {
  using Clock = std::chrono::steady_clock;
  const FirstFrames first = FindFirstFrames(recording, setup_);
  const int frames = recording.num_frames();
  const double dt = 1 / recording.rate();
  ResultWriter writer(recording, setup_);
  const auto write = [&](int k, const FrameEstimate& estimate, Clock::time_point start) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    CheckEstimate(estimate, setup_);
    writer.Write(k, estimate, seconds);
  };
  const auto show = [&](int done) {
    if (progress && !progress(done)) {
      throw Error(fmt::format("cancelled after {} of {} frames", done, frames));
    }
  };
  for (int k = first.assembled; k < frames; ++k) {
    const Clock::time_point start = Clock::now();
    write(k, k == first.assembled ? Assemble(recording.frame(k)) : Track(recording.frame(k), dt),
          start);
    show(k + 1);
  }
  int earliest = first.assembled;
  if (first.seen < earliest) Assemble(recording.frame(earliest));
  for (; earliest > first.seen; --earliest) {
    const Clock::time_point start = Clock::now();
    const FrameEstimate& estimate = Track(recording.frame(earliest - 1), dt);
    if (!IsTracked(estimate)) break;
    write(earliest - 1, estimate, start);
    show(0);
  }
  writer.WriteEarlier(earliest);
  return writer.Finish();
}

}  // namespace mmm_converter
