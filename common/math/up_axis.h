// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace mmm_converter {

/// The direction in a file's own axes that points up.
enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };
const char* Name(UpAxis axis);  ///< "+x", "+y", "+z", "-x", "-y", "-z"
/// As ParseUpAxis; nothing where the text is no axis.
std::optional<UpAxis> StatedUpAxis(const std::string& text);
/// Accepts x, y, z with or without sign, in any case. @throws Error listing what is allowed.
UpAxis ParseUpAxis(const std::string& text);

/// Proper rotation that turns this axis to +z.
Eigen::Matrix3d RotationToZUp(UpAxis axis);

}  // namespace mmm_converter
