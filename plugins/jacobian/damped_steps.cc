// SPDX-License-Identifier: MIT
#include "plugins/jacobian/damped_steps.h"

#include <algorithm>
#include <cmath>

#include "common/math/rotation.h"

namespace mmm_converter::jacobian {

using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::VectorXd;

DampedSteps::DampedSteps(const MarkerKinematics& kinematics)
    : kinematics_(kinematics), natural_(NaturalAngles(kinematics)), equations_(kinematics) {
  step_.setZero(kinematics.num_dofs());
}

double DampedSteps::Step(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                         const DampedStepOptions& options, Posture* posture) {
  // Curvature [1] that keeps the root where no marker is seen.
  constexpr double kLeastCurvature = 1e-9;
  RestEndlessJoints(kinematics_, posture->joint_angles, &natural_);
  equations_.Place(*posture);
  equations_.Linearize(z, noise_scale, options.cost.robust_distance);
  const int joints = kinematics_.num_joints();
  const double natural2 = options.cost.natural_weight * options.cost.natural_weight;
  auto H = equations_.H();
  H.diagonal().head<3>().array() += kLeastCurvature;
  H.diagonal().tail(3 + joints).array() += options.damping * options.damping;
  H.diagonal().tail(joints).array() += natural2;
  equations_.g().tail(joints) += natural2 * (natural_ - posture->joint_angles);
  equations_.HoldPressingJoints(posture->joint_angles);
  equations_.Solve(0, 0);
  step_ = equations_.step();

  const double turn = step_.segment<3>(3).norm();
  const double asked = std::max(turn, joints > 0 ? step_.tail(joints).cwiseAbs().maxCoeff() : 0.0);
  if (turn > options.limit) step_.segment<3>(3) *= options.limit / turn;
  step_.tail(joints) = step_.tail(joints).cwiseMax(-options.limit).cwiseMin(options.limit);
  posture->position += step_.head<3>();
  posture->orientation = (posture->orientation * Exp(step_.segment<3>(3))).normalized();
  posture->joint_angles = (posture->joint_angles + step_.tail(joints))
                              .cwiseMax(kinematics_.lower())
                              .cwiseMin(kinematics_.upper());
  return asked;
}

}  // namespace mmm_converter::jacobian
