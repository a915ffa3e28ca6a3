// SPDX-License-Identifier: MIT
#include "common/fit/normal_equations.h"

#include <algorithm>
#include <cmath>

#include "common/math/dense.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// A step onto a limit ends there but for rounding [rad].
constexpr double kAtLimit = 1e-12;

}  // namespace

NormalEquations::NormalEquations(const MarkerKinematics& kinematics)
    : kinematics_(kinematics),
      at_(kinematics.MakeJacobian()),
      H_(kinematics.num_dofs(), kinematics.num_dofs()),
      is_held_(kinematics.num_joints(), 0),
      damped_(kinematics.num_dofs(), kinematics.num_dofs()),
      solution_(kinematics.num_dofs(), 1) {
  residual_.setZero(3 * kinematics.num_markers());
  g_.setZero(kinematics.num_dofs());
  held_step_.setZero(kinematics.num_joints());
  step_.setZero(kinematics.num_dofs());
}

const Matrix3Xd& NormalEquations::Place(const Posture& posture) {
  kinematics_.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                             posture.joint_angles, &at_);
  return at_.p_WM;
}

void NormalEquations::Linearize(const Ref<const Matrix3Xd>& z, const VectorXd& noise_scale,
                                double robust_distance) {
  kinematics_.ComputeJacobian(&at_);
  auto J_transposed = at_.J_transposed.view();
  for (int m = 0; m < kinematics_.num_markers(); ++m) {
    const Vector3d r = z.col(m) - at_.p_WM.col(m);
    const double distance = r.norm();
    const bool is_seen = std::isfinite(distance);
    const double weight =
        is_seen ? std::sqrt(std::min(1.0, robust_distance / distance)) / noise_scale[m] : 0;
    if (weight == 0) {
      J_transposed.middleCols<3>(3 * m).setZero();
    } else if (weight != 1) {
      J_transposed.middleCols<3>(3 * m) *= weight;
    }
    residual_.segment<3>(3 * m) = is_seen ? Vector3d(weight * r) : Vector3d::Zero();
  }
  H_.SetZero();
  AddSquare(1, at_.J_transposed, &H_);
  g_.noalias() = J_transposed * residual_;
  if (kinematics_.is_root_fixed()) H_.view().diagonal().head<6>().setOnes();
}

void NormalEquations::Hold(int joint, double step) {
  is_held_[joint] = 1;
  held_step_[joint] = step;
}

void NormalEquations::HoldPressingJoints(const VectorXd& angles) {
  std::fill(is_held_.begin(), is_held_.end(), 0);
  held_step_.setZero();
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    if ((angles[j] <= kinematics_.lower()[j] + kAtLimit && g_[6 + j] < 0) ||
        (angles[j] >= kinematics_.upper()[j] - kAtLimit && g_[6 + j] > 0)) {
      Hold(j, 0);
    }
  }
}

bool NormalEquations::HoldOversteppingJoints(const VectorXd& angles) {
  bool found = false;
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    if (is_held_[j] != 0) continue;
    const double below = kinematics_.lower()[j] - angles[j];
    const double above = kinematics_.upper()[j] - angles[j];
    if (step_[6 + j] >= below && step_[6 + j] <= above) continue;
    Hold(j, step_[6 + j] < below ? below : above);
    found = true;
  }
  return found;
}

void NormalEquations::Solve(double relative, double absolute) {
  damped_ = H_;
  auto A = damped_.view();
  auto x = solution_.view().col(0);
  A.diagonal() += relative * H_.view().diagonal();
  A.diagonal().array() += absolute;
  solution_.SetZero();
  x = g_;
  const Eigen::Index n = x.size();
  for (int j = 0; j < kinematics_.num_joints(); ++j) {
    if (is_held_[j] == 0) continue;
    const int i = 6 + j;
    if (held_step_[j] != 0) {
      x.head(i) -= held_step_[j] * A.row(i).head(i).transpose();
      x.tail(n - 1 - i) -= held_step_[j] * A.col(i).tail(n - 1 - i);
    }
    A.row(i).head(i).setZero();
    A.col(i).tail(n - 1 - i).setZero();
    A(i, i) = 1;
    x[i] = 0;
  }
  Factorize(&damped_);
  SolveLower(damped_, &solution_);
  SolveLowerTransposed(damped_, &solution_);
  step_ = x;
  step_.tail(kinematics_.num_joints()) += held_step_;
}

}  // namespace mmm_converter
