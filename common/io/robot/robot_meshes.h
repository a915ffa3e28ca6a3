// SPDX-License-Identifier: MIT
#pragma once

#include "common/model/robot.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Reads the meshes of the rigid body of the segment and of those below it: what touches, and where
/// that can't be read what is looked at. What can't be read, or is not where the robot's file says,
/// is a warning.
void ReadMeshes(int segment, Robot* robot, Warnings* warnings);

}  // namespace mmm_converter
