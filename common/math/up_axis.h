// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

namespace mmm_converter {

/// The direction in a file's own axes that points up.
enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };
const char* Name(UpAxis axis);  ///< "+x", "+y", "+z", "-x", "-y", "-z"
/// Accepts x, y, z with or without sign, in any case. @throws Error listing what is allowed.
UpAxis ParseUpAxis(const std::string& text);

/// Proper rotation that turns this axis to +z.
Eigen::Matrix3d RotationToZUp(UpAxis axis);

}  // namespace mmm_converter
