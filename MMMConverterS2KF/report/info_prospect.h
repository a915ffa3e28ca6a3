// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/prospect.h"

namespace mmm_converter {

/// What a conversion would read a recording with, what it could tell and what not, in a few lines.
std::string FormatProspect(const Prospect& prospect);

/// The same as JSON.
Json ToJson(const Prospect& prospect);

}  // namespace mmm_converter
