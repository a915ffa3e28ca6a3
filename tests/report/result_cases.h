// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter::testing {

/// Results of a batch, a line of results.jsonl each: of 100 entries 97 are converted, two failed
/// for the same reason and one is missing; every tenth has a warning. Depends on the count only.
std::vector<std::string> ManyResults(int count);

/// Converted, failed and missing entries whose texts are all hostile, paths that must not become
/// links, numbers that are null or extreme, members that are missing or of another type.
std::vector<std::string> HostileResults();

/// All failed, each for a reason of its own.
std::vector<std::string> FailedResults(int count);

}  // namespace mmm_converter::testing
