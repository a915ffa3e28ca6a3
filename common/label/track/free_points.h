// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace mmm_converter {

/// How many points of a frame are nobody's, in the mean of the last half second. Where they are
/// rare, a point that is somewhat off is a marker rather than a ghost.
class FreePoints {
 public:
  /// points: in the frame; point_of_marker: -1 for a marker without; dt: since the last frame [s].
  void Count(int points, const std::vector<int>& point_of_marker, double dt) {
    constexpr double kMemory = 0.5;  // [s]
    const auto used = std::count_if(point_of_marker.begin(), point_of_marker.end(),
                                    [](int point) { return point >= 0; });
    mean_ += std::min(1.0, dt / kMemory) * (points - static_cast<double>(used) - mean_);
  }

  /// What a marker without a point costs more than where ghosts are usual, as a squared
  /// Mahalanobis distance: twice the logarithm of how much rarer ghosts are (Bar-Shalom's density
  /// of clutter).
  double Surplus() const {
    constexpr double kMost = 6;
    constexpr double kRarest = 0.2;  // [points]: what half a second can't tell from none
    return std::clamp(2 * std::log(kUsual / (mean_ + kRarest)), 0.0, kMost);
  }

 private:
  static constexpr double kUsual = 5;  // [points]
  double mean_ = kUsual;
};

}  // namespace mmm_converter
