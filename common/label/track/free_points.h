// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/label/tuning.h"

namespace mmm_converter {

/// How many points of a frame are nobody's, in the mean of the last half second. Where they are
/// rare, a point that is somewhat off is a marker rather than a ghost.
class FreePoints {
 public:
  /// points: in the frame; point_of_marker: -1 for a marker without; dt: since the last frame [s].
  void Count(int points, const std::vector<int>& point_of_marker, double dt) {
    const auto used = std::count_if(point_of_marker.begin(), point_of_marker.end(),
                                    [](int point) { return point >= 0; });
    mean_ +=
        std::min(1.0, dt / FreePointTuning::kMemory) * (points - static_cast<double>(used) - mean_);
  }

  /// What a marker without a point costs more than where ghosts are usual, as a squared
  /// Mahalanobis distance: twice the logarithm of how much rarer ghosts are (Bar-Shalom's density
  /// of clutter).
  double Surplus() const {
    return std::clamp(2 * std::log(FreePointTuning::kUsual / (mean_ + FreePointTuning::kRarest)),
                      0.0, FreePointTuning::kMostSurplus);
  }

 private:
  double mean_ = FreePointTuning::kUsual;
};

}  // namespace mmm_converter
