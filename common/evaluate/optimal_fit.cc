// SPDX-License-Identifier: MIT
#include "common/evaluate/optimal_fit.h"

#include <limits>

#include "common/fit/posture_fit.h"
#include "common/fit/posture_search.h"
#include "common/model/marker_kinematics.h"

namespace mmm_converter {
namespace {

constexpr int kFewestMarkers = 3;
constexpr int kAttempts = 20;

struct Optimum {
  Posture posture;
  double cost = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

Eigen::VectorXd OptimalDistances(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<int>& markers, const std::vector<int>& labels,
                                 const MarkerSequence& recording) {
  const MarkerKinematics kinematics(model, joints, markers);
  PostureSearch search(kinematics);
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(kinematics.num_markers());
  PostureFitOptions options;
  options.tolerance = 1e-6;
  options.max_iterations = 50;

  const int frames = recording.num_frames();
  std::vector<Optimum> optima(frames);
  Posture posture;
  bool is_assembled = false;
  const auto fit = [&](int k) {
    const Eigen::Matrix3Xd z = recording.frame(k)(Eigen::all, labels);
    if (z.array().isFinite().colwise().all().count() < kFewestMarkers) return;
    PostureFit::Result result;
    if (is_assembled) {
      result = search.fit().Solve(z, scale, options, &posture);
    } else {
      result = search.Assemble(z, scale, options, kAttempts, &posture);
      is_assembled = true;
    }
    if (result.cost < optima[k].cost) optima[k] = {posture, result.cost, result.mean_distance};
    posture = optima[k].posture;
  };
  for (int k = 0; k < frames; ++k) fit(k);
  for (int k = frames - 1; k >= 0; --k) fit(k);

  Eigen::VectorXd distances(frames);
  for (int k = 0; k < frames; ++k) distances[k] = optima[k].distance;
  return distances;
}

}  // namespace mmm_converter
