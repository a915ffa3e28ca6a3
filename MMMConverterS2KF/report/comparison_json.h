// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// All figures of a comparison; README.md says what is in it. What there is no number for is null.
Json ToJson(const Comparison& comparison);

}  // namespace mmm_converter
