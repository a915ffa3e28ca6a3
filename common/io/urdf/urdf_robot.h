// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/model/robot.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Parses a URDF with its shapes of `<collision>` and its limits of velocity. A joint that others
/// mimic is as slow as these need it. `file` is named in messages, and tells where meshes are.
/// @throws Error as ReadUrdfModel.
Robot ParseUrdfRobot(std::string_view content, const std::string& file,
                     Warnings* warnings = nullptr);

}  // namespace mmm_converter
