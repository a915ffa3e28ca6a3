// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <numbers>

namespace mmm_converter {

/// What is not known: a missing marker's coordinates, a figure of no frames.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Values are SI inside; texts and files have them in these units.
inline constexpr double kMillimetres = 1000;  ///< in a metre
inline constexpr double kMilliseconds = 1000;
inline constexpr double kPercent = 100;
inline constexpr double kDegrees = 180 / std::numbers::pi;

// With how many decimals files have them.
inline constexpr int kMillimetreDecimals = 4;
inline constexpr int kRadianDecimals = 8;
inline constexpr int kSecondDecimals = 9;

}  // namespace mmm_converter
