// SPDX-License-Identifier: MIT
#include "common/fit/posture_search.h"

#include <cmath>

#include "common/fit/rigid_shape.h"
#include "common/math/seeded_random.h"
#include "common/support/error.h"

namespace mmm_converter {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// In [0, 1), the same with every standard library.
double Uniform(std::mt19937* random) { return (*random)() * (1.0 / 4294967296.0); }

constexpr double kRandomShare = 0.8;  // of a joint's range
constexpr double kLeastGain = 0.01;
constexpr double kTurn = 2 * EIGEN_PI;  // [rad]

}  // namespace

PostureSearch::PostureSearch(const MarkerKinematics& kinematics)
    : kinematics_(kinematics),
      fit_(kinematics),
      at_(kinematics.MakeJacobian()),
      rigidity_(kinematics.num_markers()),
      squared_distances_(kinematics.num_markers()) {
  for (int m = 0; m < kinematics.num_markers(); ++m) {
    int joints = 0;
    for (int j = 0; j < kinematics.num_joints(); ++j) joints += kinematics.Moves(j, m);
    rigidity_[m] = 1.0 / ((1.0 + joints) * (1.0 + joints));
  }
  trial_.joint_angles.setZero(kinematics.num_joints());
}

void PostureSearch::FitRigid(const Ref<const Matrix3Xd>& z, Posture* posture) {
  if (kinematics_.is_root_fixed()) {
    posture->orientation = Eigen::Quaterniond(kinematics_.X_WS().linear());
    posture->position = kinematics_.X_WS().translation();
    return;
  }
  kinematics_.ComputeMarkers(Vector3d::Zero(), Matrix3d::Identity(), posture->joint_angles, &at_);
  const Eigen::Isometry3d X_WS = FitRigidPose(at_.p_WM, z, rigidity_);
  posture->orientation = Eigen::Quaterniond(X_WS.linear()).normalized();
  posture->position = X_WS.translation();
}

void PostureSearch::Unwind(const VectorXd& reference, Posture* posture) const {
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    if (!kinematics_.TurnsFreely(j)) continue;
    const double turned = posture->joint_angles[j] - reference[j];
    posture->joint_angles[j] = reference[j] + std::remainder(turned, kTurn);
  }
}

void PostureSearch::RandomizeLimb(const Ref<const Matrix3Xd>& z, Posture* posture) {
  kinematics_.ComputeMarkers(posture->position, posture->orientation.toRotationMatrix(),
                             posture->joint_angles, &at_);
  // Drawn with a probability proportional to its squared distance.
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    const double squared = (z.col(m) - at_.p_WM.col(m)).squaredNorm();
    squared_distances_[m] = std::isfinite(squared) ? squared : 0;
  }
  const int marker = IndexAtShare(Uniform(&random_), squared_distances_);
  // From one of its joints on: what is nearer to the root may be right already.
  int joints = 0;
  for (int j = 0; j < kinematics_.num_joints(); ++j) joints += kinematics_.Moves(j, marker);
  int kept = static_cast<int>(Uniform(&random_) * joints);
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    if (!kinematics_.Moves(j, marker) || kept-- > 0) continue;
    const auto [lower, upper] = kinematics_.Range(j);
    posture->joint_angles[j] =
        0.5 * (lower + upper) + (Uniform(&random_) - 0.5) * kRandomShare * (upper - lower);
  }
}

bool PostureSearch::Improve(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                            const PostureFitOptions& options, Posture* posture) {
  trial_ = *posture;
  if (random_() % 4 == 0) {
    trial_.joint_angles = fit_.natural_angles();
    FitRigid(z, &trial_);
  }
  RandomizeLimb(z, &trial_);
  return TakeIfBetter(z, noise_scale, options, posture);
}

bool PostureSearch::ImproveFrom(const VectorXd& joint_angles, const Ref<const Matrix3Xd>& z,
                                const VectorXd& noise_scale, const PostureFitOptions& options,
                                Posture* posture) {
  trial_.joint_angles = joint_angles;
  FitRigid(z, &trial_);
  return TakeIfBetter(z, noise_scale, options, posture);
}

bool PostureSearch::TakeIfBetter(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                                 const PostureFitOptions& options, Posture* posture) {
  const PostureFit::Result before = fit_.Evaluate(z, noise_scale, options, *posture);
  const PostureFit::Result after = fit_.Solve(z, noise_scale, options, &trial_);
  if (!(after.cost < (1 - kLeastGain) * before.cost)) return false;
  Unwind(posture->joint_angles, &trial_);
  *posture = trial_;
  return true;
}

PostureFit::Result PostureSearch::Assemble(const Ref<const Matrix3Xd>& z,
                                           const VectorXd& noise_scale,
                                           const PostureFitOptions& options, int attempts,
                                           Posture* posture) {
  random_.seed(1);
  posture->joint_angles = NaturalAngles(kinematics_);
  FitRigid(z, posture);
  fit_.Solve(z, noise_scale, options, posture);
  for (int i = 0; i < attempts; ++i) Improve(z, noise_scale, options, posture);
  PostureFitOptions polish = options;
  polish.tolerance *= 0.01;
  trial_.joint_angles = kinematics_.rest();
  Unwind(trial_.joint_angles, posture);
  const PostureFit::Result result = fit_.Solve(z, noise_scale, polish, posture);
  if (std::isfinite(result.cost)) return result;
  throw Error(
      "no posture of the model has a distance from the markers that is a number; look at the "
      "model's lengths and limits and at the unit of the markers");
}

}  // namespace mmm_converter
