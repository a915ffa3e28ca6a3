// SPDX-License-Identifier: MIT
#include "common/retarget/trajectory_limits.h"

#include <algorithm>
#include <cmath>

#include "common/retarget/trajectory_window.h"

namespace mmm_converter {
namespace {

constexpr double kLimitRounding = 1e-9;  // of a step, for what subtraction loses
constexpr double kDeepest = 5e-4;        // [m]
constexpr double kLiftTime = 0.1;        // [s] before and behind what is lifted

/// The highest values below q that change by no more than `step` from frame to frame.
Eigen::VectorXd HighestBelow(Eigen::VectorXd q, double step) {
  for (Eigen::Index k = 1; k < q.size(); ++k) q[k] = std::min(q[k], q[k - 1] + step);
  for (Eigen::Index k = q.size() - 1; k > 0; --k) q[k - 1] = std::min(q[k - 1], q[k] + step);
  return q;
}

}  // namespace

double CorrectJoints(const TrajectoryProblem& problem, std::vector<Posture>* postures) {
  const auto frames = static_cast<Eigen::Index>(postures->size());
  double most = 0;
  Eigen::VectorXd given(frames);
  for (int j = 0; j < problem.model->num_joints(); ++j) {
    const Segment& joint = problem.model->joint(j);
    for (Eigen::Index k = 0; k < frames; ++k) given[k] = (*postures)[k].joint_angles[j];
    Eigen::VectorXd kept = given.cwiseMax(joint.lower).cwiseMin(joint.upper);
    const double step = (1 - kLimitRounding) * problem.velocity_limits[j] / problem.rate;
    if (std::isfinite(step)) {
      kept = 0.5 * (HighestBelow(kept, step) - HighestBelow(-kept, step));
      kept = kept.cwiseMax(joint.lower).cwiseMin(joint.upper);
    }
    for (Eigen::Index k = 0; k < frames; ++k) (*postures)[k].joint_angles[j] = kept[k];
    most = std::max(most, (kept - given).cwiseAbs().maxCoeff());
  }
  return most;
}

double LiftAboveFloor(const TrajectoryProblem& problem, std::vector<Posture>* postures) {
  if (problem.balls.empty() || problem.model->is_root_fixed()) return 0;
  AimEquations equations(problem);
  const int frames = static_cast<int>(postures->size());
  const int reach = static_cast<int>(std::ceil(kLiftTime * problem.rate));
  // The most within reach, averaged over as many frames: nowhere less than what is needed.
  std::vector<double> most(frames + 2 * reach, 0.0);  // of frames from -reach on
  double lifted = 0;
  for (int k = 0; k < frames; ++k) {
    const double lift = equations.DepthOf((*postures)[k]) - kDeepest;
    lifted = std::max(lifted, lift);
    for (int i = k; lift > 0 && i <= k + 2 * reach; ++i) most[i] = std::max(most[i], lift);
  }
  for (int k = 0; k < frames && lifted > 0; ++k) {
    double sum = 0;
    for (int i = k; i <= k + 2 * reach; ++i) sum += most[i];
    (*postures)[k].position.z() += sum / (2 * reach + 1);
  }
  return lifted;
}

}  // namespace mmm_converter
