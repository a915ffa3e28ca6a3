// SPDX-License-Identifier: MIT
#pragma once

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::testing {

/// The shipped model.
KinematicModel Person(double height);

/// Bends its knees, with the feet where they are, and swings an arm: 2 s at 100 Hz.
PoseTrajectory Squat(const KinematicModel& person);

}  // namespace mmm_converter::testing
