// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mmm_converter {

/// One self-contained HTML page about a batch: what failed, distributions, a table of all entries.
/// results: a JSON object as text per entry, as in the lines of results.jsonl, in the manifest's
/// order; Error where one is none. Links to reports and motions are relative to the page.
std::string FormatBatchIndex(const std::string& title, const std::vector<std::string>& results);

}  // namespace mmm_converter
