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
  /// the angles from the natural ones (MatchCosts). No unit.
  double cost = 0;
  int matched = 0;
};

}  // namespace mmm_converter
