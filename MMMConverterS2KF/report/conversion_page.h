// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// A page (HTML) with player and plots of a conversion, or of several motions of a recording or of
/// a person. failures: of what could not be converted, a sentence each.
std::string FormatConversionPage(const std::vector<const ConversionReport*>& reports,
                                 const std::vector<std::string>& failures = {});

}  // namespace mmm_converter
