// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace mmm_converter {

// Of the values that are not NaN; NaN where there is none.

double Mean(std::span<const double> values);
double Max(std::span<const double> values);

/// Linear between the sorted values: 0 is the smallest, 100 the largest, as NumPy's default.
/// percent is in [0, 100].
double Percentile(std::span<const double> values, double percent);

inline double Median(std::span<const double> values) { return Percentile(values, 50); }

/// The value that a chi-square distributed number with so many degrees of freedom (> 0) exceeds
/// with probability 1 - `probability`; 0 < probability < 1.
double ChiSquareQuantile(double probability, int degrees);

}  // namespace mmm_converter
