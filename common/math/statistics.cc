// SPDX-License-Identifier: MIT
#include "common/math/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>
#include <cmath>

#include "common/support/units.h"

namespace mmm_converter {
double Mean(std::span<const double> values) {
  double sum = 0;
  long count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : kNaN;
}

double Max(std::span<const double> values) {
  double max = kNaN;
  for (const double value : values) max = std::fmax(max, value);
  return max;
}

double Percentile(std::span<const double> values, double percent) {
  assert(percent >= 0 && percent <= 100);
  std::vector<double> numbers;
  numbers.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(numbers),
               [](double value) { return !std::isnan(value); });
  if (numbers.empty()) return kNaN;
  const double place = percent / 100 * static_cast<double>(numbers.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  const auto at = numbers.begin() + below;
  std::nth_element(numbers.begin(), at, numbers.end());
  const double share = place - static_cast<double>(below);
  if (share == 0) return *at;
  const double above = *std::min_element(at + 1, numbers.end());
  return *at + share * (above - *at);
}

double ChiSquareQuantile(double probability, int degrees) {
  return boost::math::quantile(boost::math::chi_squared(degrees), probability);
}

}  // namespace mmm_converter
