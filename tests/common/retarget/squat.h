// SPDX-License-Identifier: MIT
#pragma once

#include "common/model/kinematic_model.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter::testing {

/// The shipped model.
KinematicModel Person(double height);

/// Bends its knees, with the feet where they are, and swings an arm: 2 s at 100 Hz.
PoseTrajectory Squat(const KinematicModel& person);

/// Shuffles along y: flat feet stand for 0.6 s, then go `step` [m] in 0.4 s, at most `lift` [m]
/// above the floor: 3 s at 100 Hz.
PoseTrajectory Shuffle(const KinematicModel& person, double step, double lift);

}  // namespace mmm_converter::testing
