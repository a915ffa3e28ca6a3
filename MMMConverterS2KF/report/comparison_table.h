// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// The figures of a comparison for people: a table for each trial, one of their means, then what
/// failed and why.
std::string FormatComparisonTable(const Comparison& comparison);

/// All figures, one line for each trial and contender; an empty cell: there is no number.
std::string FormatComparisonCsv(const Comparison& comparison);

}  // namespace mmm_converter
