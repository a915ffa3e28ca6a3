// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/pipeline.h"

namespace mmm_converter {

/// A page (HTML) with player and plots of one conversion.
std::string FormatConversionPage(const ConversionReport& report);

}  // namespace mmm_converter
