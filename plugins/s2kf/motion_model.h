// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "plugins/s2kf/belief.h"

namespace mmm_converter::s2kf {

/// Standard deviations by which the state drifts within one second; variances grow with time.
struct ProcessNoise {
  double position = 0;     ///< [m / sqrt(s)]
  double orientation = 0;  ///< [rad / sqrt(s)]
  double parameters = 0;   ///< Theta [1 / sqrt(s)]
};

/// The system model: a random walk, x_{k+1} = x_k + w, w ~ N(0, Q dt), with two additions.
///  - reversion: joint parameters drift back to the natural posture so slowly that their spread has
///  the
///    standard deviation `natural_spread` when nothing is seen for long (Ornstein-Uhlenbeck): what
///    no marker determines stays natural and does not run away.
///  - velocity: the state carries its rate v, x_{k+1} = x_k + T(dt) v with v damped by
///    `velocity_decay`; the noise then drives the rate.
struct MotionModel {
  ProcessNoise noise;
  double natural_spread = 0;  ///< of Theta [1]; 0: no reversion
  Eigen::VectorXd natural;    ///< Theta of the natural posture
  bool velocity = false;
  double velocity_decay = 0.2;  ///< time constant of the damping [s]
  ProcessNoise velocity_noise;  ///< of the rate, per sqrt(s)

  /// The belief dt seconds later, in closed form.
  void Predict(double dt, RootParameters root, Belief* belief) const;
};

}  // namespace mmm_converter::s2kf
