// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/model/posture.h"

namespace mmm_converter {

/// A posture, and which point of a frame is which marker in it.
struct BodyMatch {
  Posture posture;                   ///< tracked joints
  std::vector<int> point_of_marker;  ///< -1: none
  /// Sum over the markers of min(d^2 / v, kUnmatched), d the distance of its point and v the
  /// variance of its place and of the posture; and kNaturalWeight times the squared distances of
  /// the angles from the natural ones. No unit.
  double cost = 0;
  int matched = 0;
};

/// What a match costs.
struct MatchCosts {
  static constexpr double kUnmatched = 9;        ///< of a marker without point: three deviations
  static constexpr double kSettled = 0.015;      ///< [m] what a posture may still be off
  static constexpr double kNaturalWeight = 0.3;  ///< [1/rad^2]
};

}  // namespace mmm_converter
