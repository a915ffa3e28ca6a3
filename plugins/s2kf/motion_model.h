// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "plugins/s2kf/belief.h"

namespace mmm_converter::s2kf {

/// Standard deviations by which the state, or its rate, drifts within one second; variances grow
/// with time.
struct ProcessNoise {
  double position = 0;     ///< [m / sqrt(s)], of the rate [m/s / sqrt(s)]
  double orientation = 0;  ///< [rad / sqrt(s)], of the rate [rad/s / sqrt(s)]
  double parameters = 0;   ///< Theta [1 / sqrt(s)], of the rate [1/s / sqrt(s)]

  /// Of variances that are `scale` times as large.
  ProcessNoise Scaled(double scale) const;
};

/// The same linear map of every coordinate [x; v] of the error state, x a state and v its rate, for
/// each of the three kinds of state. Without rates only (0, 0) counts.
struct CoordinateMaps {
  Eigen::Matrix2d position = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d orientation = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d parameters = Eigen::Matrix2d::Identity();

  /// Of state i.
  const Eigen::Matrix2d& Of(int i) const;
  CoordinateMaps Inverse(bool velocity) const;
  /// dx = M dx; dx holds n states, then, with rates, theirs.
  void Apply(int n, Eigen::VectorXd* dx) const;
  /// P = M P M^T.
  void Apply(int n, Eigen::MatrixXd* P) const;
};

/// The system model, in closed form for any step.
///  - random walk: x stays; the noise drives it. Joint parameters drift back to the natural posture
///    so slowly that their spread has the standard deviation `natural_spread` when nothing is seen
///    for long (Ornstein-Uhlenbeck): what no marker determines stays natural and does not run away.
///  - velocity: the state carries its rate; the noise drives the rate, as an acceleration that is
///    constant within a step. The root's rate dies out with `velocity_decay`. A joint parameter is
///    drawn to the natural posture by a critically damped spring, so soft that its spread is again
///    `natural_spread` (Matern 3/2).
struct MotionModel {
  bool velocity = false;
  ProcessNoise noise;           ///< of the state; with velocity of the rate
  double natural_spread = 0;    ///< of Theta [1]; 0: no way back
  Eigen::VectorXd natural;      ///< Theta of the natural posture; NaN: of this joint, any
  double velocity_decay = 0.2;  ///< [s]

  /// x+ = natural + F (x - natural) + w, w ~ N(0, Q).
  struct Step {
    CoordinateMaps F;
    CoordinateMaps Q;
  };
  Step StepOf(double dt) const;

  /// The belief dt seconds later.
  void Predict(double dt, RootParameters root, Belief* belief) const;
};

}  // namespace mmm_converter::s2kf
