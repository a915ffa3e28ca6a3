// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/conversion/conversion.h"

namespace mmm_converter {

/// A conversion in a dozen lines, for people.
std::string FormatSummary(const ConversionReport& report);

/// A conversion as JSON; the README says what is in it.
std::string FormatSummaryJson(const ConversionReport& report);

}  // namespace mmm_converter
