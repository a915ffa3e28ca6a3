// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// The candidate that `name` is most likely a misspelling of (edit distance, letter case ignored);
/// empty where none is near.
std::string ClosestName(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace mmm_converter
