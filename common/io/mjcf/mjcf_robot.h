// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/mjcf/mjcf_text.h"
#include "common/model/robot.h"
#include "common/support/warnings.h"

namespace mmm_converter {

bool IsMjcf(std::string_view content);  ///< by its root

/// Reads an MJCF with what it includes. The robot is the body of the world that has a free joint
/// and joints below it, of several the one with the most joints; else all that have joints, on a
/// root that is fixed. Three slides and three hinges of a body of the world are a free joint.
/// Segments have the names of their joints, bodies without joints their own;
/// a joint's q counts from `ref`. Joints that an `<equality>` ties to another follow it; other
/// equalities are not kept, with a warning. Sites called `<label>_marker` are markers `label`.
/// Limits of velocity are not known.
/// @throws Error naming file and line: not an MJCF, files that are not there or include each other,
///         classes that are not there, names twice, numbers that are none, ball joints and elements
///         that make bodies and are not read, no body with joints.
Robot ReadMjcf(const std::string& path, Warnings* warnings = nullptr);

/// As ReadMjcf; `file` is named in messages, and tells where meshes are.
Robot ParseMjcf(std::string_view content, const std::string& file, const MjcfPartReader& read_part,
                Warnings* warnings = nullptr);

}  // namespace mmm_converter
