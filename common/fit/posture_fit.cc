// SPDX-License-Identifier: MIT
#include "common/fit/posture_fit.h"

#include <algorithm>
#include <cmath>

#include "common/math/rotation.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd NaturalAngles(const MarkerKinematics& kinematics) {
  return kinematics.rest().cwiseMax(kinematics.lower()).cwiseMin(kinematics.upper());
}

void RestEndlessJoints(const MarkerKinematics& kinematics, const VectorXd& angles,
                       VectorXd* natural) {
  for (int j = 0; j < kinematics.num_joints(); ++j) {
    if (kinematics.IsEndless(j)) (*natural)[j] = angles[j];
  }
}

PostureFit::PostureFit(const MarkerKinematics& kinematics)
    : kinematics_(kinematics),
      natural_(NaturalAngles(kinematics)),
      start_(natural_),
      resting_(kinematics.RestingJoints()),
      equations_(kinematics) {
  trial_.joint_angles.setZero(kinematics.num_joints());
}

PostureFit::Result PostureFit::Evaluate(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                                        const PostureFitOptions& options, const Posture& posture) {
  start_ = posture.joint_angles;
  RestEndlessJoints(kinematics_, start_, &natural_);
  return ComputeCost(z, noise_scale, options, posture);
}

PostureFit::Result PostureFit::ComputeCost(const Ref<const Matrix3Xd>& z,
                                           const VectorXd& noise_scale,
                                           const PostureFitOptions& options,
                                           const Posture& posture) {
  const Matrix3Xd& markers = equations_.Place(posture);
  Result result;
  int seen = 0;
  double weights = 0;
  const double h = options.robust_distance;
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    const double r = (z.col(m) - markers.col(m)).norm();
    if (!std::isfinite(r)) continue;
    result.cost += (r <= h ? r * r : 2 * h * r - h * h) / (noise_scale[m] * noise_scale[m]);
    result.mean_distance += r;
    if (!options.pulls.empty()) weights += 1 / (noise_scale[m] * noise_scale[m]);
    ++seen;
  }
  result.mean_distance /= std::max(seen, 1);
  result.cost += options.natural_weight * options.natural_weight *
                 (posture.joint_angles - natural_).squaredNorm();
  result.cost +=
      options.start_weight * options.start_weight * (posture.joint_angles - start_).squaredNorm();
  for (const JointPull& pull : options.pulls) {
    const double off = posture.joint_angles[pull.joint] - pull.value;
    result.cost += weights * pull.weight * off * off;
  }
  seen_weight_ = weights;
  return result;
}

void PostureFit::Linearize(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                           const PostureFitOptions& options, const Posture& posture) {
  equations_.Linearize(z, noise_scale, options.robust_distance);
  const int joints = kinematics_.num_joints();
  const double w2 = options.natural_weight * options.natural_weight;
  const double v2 = options.start_weight * options.start_weight;
  equations_.H().diagonal().tail(joints).array() += w2 + v2;
  equations_.g().tail(joints) +=
      w2 * (natural_ - posture.joint_angles) + v2 * (start_ - posture.joint_angles);
  for (const JointPull& pull : options.pulls) {
    const double weight = seen_weight_ * pull.weight;
    equations_.H()(6 + pull.joint, 6 + pull.joint) += weight;
    equations_.g()[6 + pull.joint] += weight * (pull.value - posture.joint_angles[pull.joint]);
  }
}

const VectorXd& PostureFit::Step(const Posture& posture, double damping) {
  // Below this curvature [m^2/rad^2] a direction is not determined by any marker.
  constexpr double kLeastCurvature = 1e-9;
  // Each solve can push another joint over its limit; what is left after these is cut.
  constexpr int kSolves = 3;
  equations_.HoldPressingJoints(posture.joint_angles);
  equations_.Solve(damping, kLeastCurvature);
  for (int i = 1; i < kSolves && equations_.HoldOversteppingJoints(posture.joint_angles); ++i) {
    equations_.Solve(damping, kLeastCurvature);
  }
  return equations_.step();
}

PostureFit::Result PostureFit::Solve(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                                     const PostureFitOptions& options, Posture* posture) {
  constexpr double kLeastDamping = 1e-7;
  constexpr double kMostDamping = 1e6;
  posture->joint_angles =
      posture->joint_angles.cwiseMax(kinematics_.lower()).cwiseMin(kinematics_.upper());
  for (const int j : resting_) posture->joint_angles[j] = natural_[j];
  double damping = 1e-3;
  Result best = Evaluate(z, noise_scale, options, *posture);
  int iteration = 0;
  while (iteration < options.max_iterations && !best.converged) {
    Linearize(z, noise_scale, options, *posture);
    bool accepted = false;
    while (!accepted && iteration < options.max_iterations) {
      ++iteration;
      const VectorXd& step = Step(*posture, damping);
      trial_.position = posture->position + step.head<3>();
      trial_.orientation = (posture->orientation * Exp(step.segment<3>(3))).normalized();
      trial_.joint_angles = (posture->joint_angles + step.tail(kinematics_.num_joints()))
                                .cwiseMax(kinematics_.lower())
                                .cwiseMin(kinematics_.upper());
      const Result trial = ComputeCost(z, noise_scale, options, trial_);
      accepted = trial.cost < best.cost;
      if (accepted) {
        const bool converged = best.cost - trial.cost < options.tolerance * best.cost;
        *posture = trial_;
        best = trial;
        best.converged = converged;
        damping = std::max(damping * 0.1, kLeastDamping);
      } else {
        damping *= 10;
        if (damping > kMostDamping) {
          best.converged = true;
          break;
        }
      }
    }
  }
  best.iterations = iteration;
  return best;
}

}  // namespace mmm_converter
