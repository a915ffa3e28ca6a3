// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// The candidate that `name` is most likely a misspelling of (edit distance, letter case ignored);
/// empty where none is near.
std::string ClosestName(std::string_view name, const std::vector<std::string>& candidates);

/// `a, b, ...`: at most that many of the names.
std::string FirstNames(const std::vector<std::string>& names, std::size_t most = 12);

/// `a, b or c`; empty for no names.
std::string JoinNames(const std::vector<std::string>& names, std::string_view last = " or ");

}  // namespace mmm_converter
