// SPDX-License-Identifier: MIT
#pragma once

#include "common/pipeline/conversion.h"
#include "common/retarget/robot_body.h"

namespace mmm_converter {

struct LoadedRobot {
  Robot robot;
  RobotBody body;
};

/// The robot with its map and the meshes of its feet; what makes its soles doubtful is a warning.
/// @throws Error where it can't be read, its limbs or soles are not known, or it has no legs and
/// objects come along.
LoadedRobot ReadRobot(const RobotRequest& request, Warnings* warnings);

/// The map of what can be read alone, as text, with where its soles are or why they are not known.
/// @throws Error where it can't be read, or its limbs are not known.
std::string DescribeRobotMap(const RobotRequest& request, Warnings* warnings);

}  // namespace mmm_converter
