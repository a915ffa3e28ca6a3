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
  return VectorXd::Zero(kinematics.num_joints())
      .cwiseMax(kinematics.lower())
      .cwiseMin(kinematics.upper());
}

PostureFit::PostureFit(const MarkerKinematics& kinematics)
    : kinematics_(kinematics),
      natural_(NaturalAngles(kinematics)),
      start_(natural_),
      at_(kinematics.MakeJacobian()),
      llt_(kinematics.num_dofs()) {
  const int n = kinematics.num_dofs();
  J_.setZero(3 * kinematics.num_markers(), n);
  residual_.setZero(3 * kinematics.num_markers());
  hessian_.setZero(n, n);
  gradient_.setZero(n);
  damped_.setZero(n, n);
  step_.setZero(n);
  trial_.joint_angles.setZero(kinematics.num_joints());
}

PostureFit::Result PostureFit::Evaluate(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                                        const PostureFitOptions& options, const Posture& posture) {
  start_ = posture.joint_angles;
  return ComputeCost(z, noise_scale, options, posture);
}

PostureFit::Result PostureFit::ComputeCost(const Ref<const Matrix3Xd>& z,
                                           const VectorXd& noise_scale,
                                           const PostureFitOptions& options,
                                           const Posture& posture) {
  kinematics_.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                             posture.joint_angles, &at_);
  Result result;
  int seen = 0;
  const double h = options.robust_distance;
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    const double r = (z.col(m) - at_.p_WM.col(m)).norm();
    if (!std::isfinite(r)) continue;
    result.cost += (r <= h ? r * r : 2 * h * r - h * h) / (noise_scale[m] * noise_scale[m]);
    result.mean_distance += r;
    ++seen;
  }
  result.mean_distance /= std::max(seen, 1);
  result.cost += options.natural_weight * options.natural_weight *
                 (posture.joint_angles - natural_).squaredNorm();
  result.cost +=
      options.start_weight * options.start_weight * (posture.joint_angles - start_).squaredNorm();
  return result;
}

void PostureFit::Linearize(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                           const PostureFitOptions& options, const Posture& posture) {
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
    const double weight =
        std::sqrt(std::min(1.0, options.robust_distance / distance)) / noise_scale[m];
    J_.middleRows<3>(3 * m) = weight * at_.J.middleRows<3>(3 * m);
    residual_.segment<3>(3 * m) = weight * r;
  }
  const int joints = kinematics_.num_joints();
  const double w2 = options.natural_weight * options.natural_weight;
  hessian_.triangularView<Eigen::Lower>().setZero();
  hessian_.selfadjointView<Eigen::Lower>().rankUpdate(J_.transpose());
  const double v2 = options.start_weight * options.start_weight;
  hessian_.diagonal().tail(joints).array() += w2 + v2;
  gradient_.noalias() = J_.transpose() * residual_;
  gradient_.tail(joints) +=
      w2 * (natural_ - posture.joint_angles) + v2 * (start_ - posture.joint_angles);
}

void PostureFit::ComputeStep(const Posture& posture, double damping) {
  // Below this curvature [m^2/rad^2] a direction is not determined by any marker.
  constexpr double kLeastCurvature = 1e-9;
  damped_.triangularView<Eigen::Lower>() = hessian_;
  damped_.diagonal() += damping * hessian_.diagonal();
  damped_.diagonal().array() += kLeastCurvature;
  step_ = gradient_;
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    const double angle = posture.joint_angles[j];
    const double slope = gradient_[6 + j];
    const bool held = (angle <= kinematics_.lower()[j] && slope < 0) ||
                      (angle >= kinematics_.upper()[j] && slope > 0);
    if (!held) continue;
    damped_.row(6 + j).head(6 + j).setZero();
    damped_.col(6 + j).tail(kinematics_.num_dofs() - 7 - j).setZero();
    damped_(6 + j, 6 + j) = 1;
    step_[6 + j] = 0;
  }
  llt_.compute(damped_);
  llt_.solveInPlace(step_);
}

PostureFit::Result PostureFit::Solve(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                                     const PostureFitOptions& options, Posture* posture) {
  constexpr double kLeastDamping = 1e-7;
  constexpr double kMostDamping = 1e6;
  posture->joint_angles =
      posture->joint_angles.cwiseMax(kinematics_.lower()).cwiseMin(kinematics_.upper());
  double damping = 1e-3;
  Result best = Evaluate(z, noise_scale, options, *posture);
  int iteration = 0;
  while (iteration < options.max_iterations && !best.converged) {
    Linearize(z, noise_scale, options, *posture);
    bool accepted = false;
    while (!accepted && iteration < options.max_iterations) {
      ++iteration;
      ComputeStep(*posture, damping);
      trial_.position = posture->position + step_.head<3>();
      trial_.orientation = (posture->orientation * Exp(step_.segment<3>(3))).normalized();
      trial_.joint_angles = (posture->joint_angles + step_.tail(kinematics_.num_joints()))
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
