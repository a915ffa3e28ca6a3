// SPDX-License-Identifier: MIT
#include "common/live/latency_histogram.h"

#include <algorithm>
#include <cmath>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kShortest = 1e-6;  // [s]
constexpr double kStep = 1.02;

}  // namespace

void LatencyHistogram::Add(double seconds) {
  const double step = std::log(std::max(seconds, kShortest) / kShortest) / std::log(kStep);
  const auto last = static_cast<double>(counts_.size() - 1);
  ++counts_[static_cast<std::size_t>(std::clamp(step, 0.0, last))];
  ++count_;
  longest_ = std::max(longest_, seconds);
}

double LatencyHistogram::Quantile(double share) const {
  if (count_ == 0) return kNaN;
  const double wanted = share * static_cast<double>(count_);
  std::int64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i];
    if (static_cast<double>(below) >= wanted) {
      return std::min(longest_, kShortest * std::pow(kStep, static_cast<double>(i + 1)));
    }
  }
  return longest_;
}

}  // namespace mmm_converter
