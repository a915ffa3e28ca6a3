// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace mmm_converter {

// What no body of a person, a robot or an object has: the one table of readers of models, maps and
// tables. A number beyond it is of another unit or a slip, and its squares and products would end
// as no numbers in a fit. Formats of persons have narrower bounds of their own.

inline constexpr double kLongestLength = 100;      ///< [m] between two joints, or of a marker
inline constexpr double kHeaviestBody = 1e6;       ///< [kg]
inline constexpr double kLargestInertia = 1e9;     ///< [kg m^2]
inline constexpr double kFarthestTurn = 1e6;       ///< [rad] "no limit" of real files is some 1e5
inline constexpr double kLargestMultiplier = 1e4;  ///< of a joint that follows another
inline constexpr double kLargestForce = 1e6;       ///< [N], [N m]
inline constexpr double kLongestDirection = 1e6;   ///< of what only its direction counts

/// False for what is no number.
inline bool IsWithin(double value, double most) { return std::abs(value) <= most; }

}  // namespace mmm_converter
