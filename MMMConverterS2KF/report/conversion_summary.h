// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// A conversion in a dozen lines, for people; the last is the verdict.
std::string FormatSummary(const ConversionReport& report);

/// The same as JSON; README.md says what is in it.
Json ToJson(const ConversionReport& report);

/// A line of the level, and one of each reason.
std::string FormatVerdict(const Verdict& verdict);

/// {"level", "reasons"}.
Json ToJson(const Verdict& verdict);

}  // namespace mmm_converter
