// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// What joints may do between frames.
struct JointBounds {
  Eigen::VectorXd lower, upper, velocity;  ///< by joint of the trajectory; infinity: none
};

/// The motion at another rate, from its first time on. Between two frames it is the cubic whose
/// slopes at both are central differences, of the root's rotation in the tangent space of the first
/// frame; what was a frame stays as it was. A joint that would go faster than its bound goes
/// straight there, and stays within its limits. Deviations and derivatives are left out.
PoseTrajectory Resample(const PoseTrajectory& motion, double rate, const JointBounds& bounds);

}  // namespace mmm_converter
