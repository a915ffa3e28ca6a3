// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace mmm_converter {

/// Counts times in steps of 2 % from 1 us to 100 s; nothing is allocated.
class LatencyHistogram {
 public:
  void Add(double seconds);
  std::int64_t count() const { return count_; }
  double longest() const { return longest_; }  ///< [s]
  /// [s], at most 2 % above; NaN: nothing was counted. share in (0, 1].
  double Quantile(double share) const;

 private:
  std::array<std::int64_t, 1000> counts_{};
  std::int64_t count_ = 0;
  double longest_ = 0;
};

}  // namespace mmm_converter
