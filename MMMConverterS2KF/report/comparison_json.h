// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/evaluate/comparison.h"

namespace mmm_converter {

/// All figures of a comparison as JSON; the application's README says what is in it. What there is
/// no number for is null.
std::string FormatComparisonJson(const Comparison& comparison);

}  // namespace mmm_converter
