// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace mmm_converter {

// Cauchy's robust cost of a squared distance in standard deviations: as the square while it is
// below scale^2, growing with its logarithm beyond.

inline double CauchyCost(double square, double scale) {
  return scale * scale * std::log1p(square / (scale * scale));
}

/// Of the square in the iteratively reweighted problem: the slope of CauchyCost.
inline double CauchyWeight(double square, double scale) {
  return 1 / (1 + square / (scale * scale));
}

}  // namespace mmm_converter
