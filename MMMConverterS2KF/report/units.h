// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>

namespace mmm_converter {

// Values are SI inside; texts and files have them in these units.
inline constexpr double kMillimetres = 1000;  // in a metre
inline constexpr double kMilliseconds = 1000;
inline constexpr double kPercent = 100;
inline constexpr double kDegrees = 180 / std::numbers::pi;

}  // namespace mmm_converter
