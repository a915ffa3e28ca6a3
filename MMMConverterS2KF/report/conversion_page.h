// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// A page (HTML) with player and plots of a conversion, or of several motions of a recording.
std::string FormatConversionPage(const std::vector<const ConversionReport*>& reports);

}  // namespace mmm_converter
