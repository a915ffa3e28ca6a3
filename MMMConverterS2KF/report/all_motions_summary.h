// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/all_motions.h"

namespace mmm_converter {

/// A line for each motion of a file, and one for the file.
std::string FormatAllMotions(const AllMotions& all);

/// As JSON: the summary of each motion, or why there is none.
Json ToJson(const AllMotions& all);

}  // namespace mmm_converter
