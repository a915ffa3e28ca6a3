// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/model/marker_kinematics.h"

namespace mmm_converter::s2kf {

enum class LimitFunction { kSine, kTanh };

/// Maps unbounded joint parameters Theta to joint angles inside their limits,
///   theta = (u - l)/2 f(Theta) + (l + u)/2,   f = sin (Steinbring et al., eq. for the joints) or
///   tanh.
/// Without limits (-infinity to infinity) theta = 2 pi Theta: Theta counts turns; or, of a joint
/// with a reach, theta = rest + reach Theta.
class JointLimitTransform {
 public:
  JointLimitTransform(LimitFunction function, const Eigen::VectorXd& lower,
                      const Eigen::VectorXd& upper);
  JointLimitTransform(LimitFunction function, const MarkerKinematics& kinematics);

  LimitFunction function() const { return function_; }
  bool is_linear(int joint) const { return is_linear_[joint]; }  ///< without limits
  /// (u - l)/2; 2 pi or the reach [rad], sliding [m]
  const Eigen::VectorXd& half_range() const { return half_range_; }
  /// (l + u)/2; 0 or the rest [rad], sliding [m]
  const Eigen::VectorXd& middle() const { return middle_; }

  double Angle(int joint, double parameter) const;  ///< theta [rad]
  double Slope(int joint, double parameter) const;  ///< d theta / d Theta [rad]

  /// Theta of an angle, kept away from the limits so far that Slope stays above a twentieth of its
  /// largest value: a filter that starts on a limit must be able to leave it.
  double Parameter(int joint, double angle) const;

  /// Standard deviation of theta where Theta ~ N(mean, deviation^2): exact for the sine, first
  /// order for tanh.
  double AngleDeviation(int joint, double mean, double deviation) const;

  /// The sine maps Theta, pi - Theta and Theta + 2 pi to the same angle. Brings Theta into
  /// [-pi/2, pi/2]; true where its sign has turned, as with pi - Theta.
  bool Fold(int joint, double* parameter) const;

 private:
  LimitFunction function_;
  Eigen::Array<bool, Eigen::Dynamic, 1> is_linear_;
  Eigen::VectorXd half_range_;
  Eigen::VectorXd middle_;
};

}  // namespace mmm_converter::s2kf
