// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/model/robot.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Reads a URDF (`<robot>` of `<link>`) or an MJCF (`<mujoco>`), told by its content.
/// @throws Error as ReadUrdfModel and ReadMjcf, and where it is neither.
Robot ReadRobotFile(const std::string& path, Warnings* warnings = nullptr);

}  // namespace mmm_converter
