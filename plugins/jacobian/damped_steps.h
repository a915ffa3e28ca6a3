// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/fit/normal_equations.h"
#include "common/fit/posture_fit.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter::jacobian {

struct DampedStepOptions {
  double damping = 0.1;    ///< lambda [m/rad]
  double limit = 0.02;     ///< of a joint's or the root's rotation in a step [rad]
  PostureFitOptions cost;  ///< robust_distance and natural_weight
};

/// Damped least squares (Wampler 1986; Nakamura, Hanafusa 1986): a step
///   dq = (J^T W J + lambda^2 I)^-1 J^T W (z - p(q)),
/// over the joints that do not press on a joint limit (those are held: what they ask for must not
/// slow the others down). Then each joint's step and the root's rotation are cut to the step limit.
/// The root's position is neither damped nor limited. No allocation after construction.
class DampedSteps {
 public:
  /// kinematics must outlive it.
  explicit DampedSteps(const MarkerKinematics& kinematics);

  /// Moves the posture (tracked joints) by one step. z: 3 x markers [m], NaN = not seen.
  /// noise_scale: per marker. Returns the largest rotation that the step asked for, before it was
  /// cut [rad].
  double Step(const Eigen::Ref<const Eigen::Matrix3Xd>& z, const Eigen::VectorXd& noise_scale,
              const DampedStepOptions& options, Posture* posture);

 private:
  const MarkerKinematics& kinematics_;
  Eigen::VectorXd natural_;
  NormalEquations equations_;
  Eigen::VectorXd step_;
};

}  // namespace mmm_converter::jacobian
