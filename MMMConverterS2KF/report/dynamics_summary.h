// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/dynamics/dynamics_check.h"

namespace mmm_converter {

/// Figures and checks, for people; the last line is one sentence.
std::string FormatDynamicsSummary(const DynamicsReport& report);

/// All figures as JSON; README.md says what is in it. What there is no number for is null.
Json ToJson(const DynamicsReport& report);

/// The verdict in one sentence.
std::string DynamicsSentence(const DynamicsReport& report);

}  // namespace mmm_converter
