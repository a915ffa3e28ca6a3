// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter::testing {

/// Results of a batch, an object each as in results.jsonl: of 100 entries 97 are converted, two
/// failed for the same reason and one is missing; every tenth has a warning. Depends on the count
/// only.
std::vector<Json> ManyResults(int count);

/// Converted, failed and missing entries whose texts are all hostile, paths that must not become
/// links, numbers that are null or extreme, members that are missing or of another type.
std::vector<Json> HostileResults();

/// All failed, each for a reason of its own.
std::vector<Json> FailedResults(int count);

}  // namespace mmm_converter::testing
