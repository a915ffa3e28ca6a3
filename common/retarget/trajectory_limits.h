// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/retarget/trajectory_fit.h"

namespace mmm_converter {

/// Brings each joint's trajectory within its limits of position and velocity, by the least that
/// its farthest frame has to move: halfway between the lowest trajectory above it and the highest
/// below it that are no faster. Returns the most that a joint moved [rad, m].
double CorrectJoints(const TrajectoryProblem& problem, std::vector<Posture>* postures);

/// Lifts the root, smoothly over time, where a ball is below the floor by more than half a
/// millimetre. Returns the most that it was lifted [m].
double LiftAboveFloor(const TrajectoryProblem& problem, std::vector<Posture>* postures);

}  // namespace mmm_converter
