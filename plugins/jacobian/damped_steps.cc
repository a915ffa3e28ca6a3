// SPDX-License-Identifier: MIT
#include "plugins/jacobian/damped_steps.h"

#include <algorithm>
#include <cmath>

#include "common/math/rotation.h"

namespace mmm_converter::jacobian {

using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

DampedSteps::DampedSteps(const MarkerKinematics& kinematics)
    : kinematics_(kinematics),
      natural_(NaturalAngles(kinematics)),
      at_(kinematics.MakeJacobian()),
      llt_(kinematics.num_dofs()) {
  J_.setZero(3 * kinematics.num_markers(), kinematics.num_dofs());
  residual_.setZero(3 * kinematics.num_markers());
  hessian_.setZero(kinematics.num_dofs(), kinematics.num_dofs());
  step_.setZero(kinematics.num_dofs());
}

void DampedSteps::Linearize(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                            double robust_distance, const Posture& posture) {
  kinematics_.ComputeJacobian(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &at_);
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    const Vector3d r = z.col(m) - at_.p_WM.col(m);
    const double distance = r.norm();
    if (!std::isfinite(distance)) {
      J_.middleRows<3>(3 * m).setZero();
      residual_.segment<3>(3 * m).setZero();
      continue;
    }
    const double weight = std::sqrt(std::min(1.0, robust_distance / distance)) / noise_scale[m];
    J_.middleRows<3>(3 * m) = weight * at_.J.middleRows<3>(3 * m);
    residual_.segment<3>(3 * m) = weight * r;
  }
  hessian_.triangularView<Eigen::Lower>().setZero();
  hessian_.selfadjointView<Eigen::Lower>().rankUpdate(J_.transpose());
  step_.noalias() = J_.transpose() * residual_;
}

void DampedSteps::HoldJointsOnLimits(const Posture& posture) {
  const int joints = kinematics_.num_joints();
  for (int j = 0; j < joints; ++j) {
    const double angle = posture.joint_angles[j];
    const double slope = step_[6 + j];
    const bool held = (angle <= kinematics_.lower()[j] && slope < 0) ||
                      (angle >= kinematics_.upper()[j] && slope > 0);
    if (!held) continue;
    hessian_.row(6 + j).head(6 + j).setZero();
    hessian_.col(6 + j).tail(joints - 1 - j).setZero();
    hessian_(6 + j, 6 + j) = 1;
    step_[6 + j] = 0;
  }
}

double DampedSteps::Step(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                         const DampedStepOptions& options, Posture* posture) {
  // Curvature [1] that keeps the root where no marker is seen.
  constexpr double kLeastCurvature = 1e-9;
  Linearize(z, noise_scale, options.cost.robust_distance, *posture);
  const int joints = kinematics_.num_joints();
  const double natural2 = options.cost.natural_weight * options.cost.natural_weight;
  hessian_.diagonal().head<3>().array() += kLeastCurvature;
  hessian_.diagonal().tail(3 + joints).array() += options.damping * options.damping;
  hessian_.diagonal().tail(joints).array() += natural2;
  step_.tail(joints) += natural2 * (natural_ - posture->joint_angles);
  HoldJointsOnLimits(*posture);
  llt_.compute(hessian_);
  llt_.solveInPlace(step_);

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
