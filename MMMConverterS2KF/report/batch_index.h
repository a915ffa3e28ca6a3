// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {

/// One self-contained HTML page about a batch: what failed, distributions, a table of all entries.
/// results: an object for each entry, as in the lines of results.jsonl, in the manifest's order.
/// Links to reports and motions are relative to the page.
std::string FormatBatchIndex(const std::string& title, const std::vector<Json>& results);

}  // namespace mmm_converter
