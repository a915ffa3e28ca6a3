// SPDX-License-Identifier: MIT
#include "common/motion/flat_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

constexpr double kNearLowest = 0.015;  // [m]
constexpr double kSlowUpwards = 0.06;  // [m/s]
constexpr double kLowestPercent = 5;

}  // namespace

std::vector<int> FlatFrames(const MarkerSequence& recording, const std::vector<int>& labels) {
  const int n = recording.num_frames();
  const auto height = [&](int k, std::size_t i) { return recording.frame(k)(2, labels[i]); };
  std::vector<double> lowest;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::vector<double> heights;
    for (int k = 0; k < n; ++k) {
      if (std::isfinite(height(k, i))) heights.push_back(height(k, i));
    }
    if (heights.empty()) return {};
    lowest.push_back(Percentile(heights, kLowestPercent));
  }
  std::vector<int> flat;
  for (int k = 0; k < n; ++k) {
    const int before = std::max(0, k - 1), after = std::min(n - 1, k + 1);
    const double time = (after - before) / recording.rate();
    bool is_flat = !labels.empty();
    for (std::size_t i = 0; i < labels.size() && is_flat; ++i) {
      const double rise = time > 0 ? (height(after, i) - height(before, i)) / time : 0;
      is_flat = height(k, i) < lowest[i] + kNearLowest && std::abs(rise) < kSlowUpwards;
    }
    if (is_flat) flat.push_back(k);
  }
  return flat;
}

}  // namespace mmm_converter
