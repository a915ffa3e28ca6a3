// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// A gnuplot script with its data: marker distance over time, a figure for each trial, drawn into
/// SVG files beside the script (`stem`-1.svg, ...). Of several runs: the mean, and the band of 5 to
/// 95 %.
std::string FormatComparisonPlot(const Comparison& comparison, const std::string& stem);

}  // namespace mmm_converter
