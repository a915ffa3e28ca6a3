// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/posture.h"

namespace mmm_converter {

/// How the errors of postures hang together from a time on.
struct PoseCorrelation {
  double time = 0;  ///< [s]
  Eigen::MatrixXd correlation;
};

/// Postures of one model over time. Each posture's joint_angles follow joint_names.
struct PoseTrajectory {
  double rate = 0;        ///< [Hz]
  double first_time = 0;  ///< [s]
  std::vector<std::string> joint_names;
  std::vector<Posture> postures;
  /// Empty, or one column a frame: standard deviations of [root position (W) 3 [m]; root rotation
  /// (body) 3 [rad]; joint angles [rad]].
  Eigen::MatrixXd standard_deviations;
  /// By time, each until the next: correlations of the errors of these, in the same order; empty:
  /// they are taken as independent.
  std::vector<PoseCorrelation> correlations;
  /// Empty, or one column a frame: first and second derivatives of [root position (W) 3 [m/s,
  /// m/s^2]; root rotation: angular velocity and its derivative (W) 3 [rad/s, rad/s^2]; joint
  /// angles [rad/s, rad/s^2]].
  Eigen::MatrixXd velocities;
  Eigen::MatrixXd accelerations;

  int num_frames() const { return static_cast<int>(postures.size()); }
  double time(int k) const { return first_time + k / rate; }
};

/// How the deviations of one frame hang together.
struct PoseCovariance {
  int frame = 0;
  /// Of what its trajectory's standard deviations are of, which are the roots of its diagonal
  /// [m, rad]: symmetric, not negative.
  Eigen::MatrixXd covariance;
};

}  // namespace mmm_converter
