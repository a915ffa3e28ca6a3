// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/dynamics/retarget_run.h"

namespace mmm_converter {

/// For people; the last line is the verdict.
std::string FormatRetargetSummary(const RetargetReport& report);

/// All figures as JSON: metres, radians, seconds. What there is no number for is null.
Json ToJson(const RetargetReport& report);

}  // namespace mmm_converter
