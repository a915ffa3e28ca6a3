// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// Without white space and NUL at both ends.
std::string_view Trim(std::string_view text);

/// ASCII letters in lower case, everything else as it is.
std::string ToLower(std::string_view text);

bool EqualIgnoringCase(std::string_view a, std::string_view b);

/// A whole text as a number in C notation, white space around it allowed; "nan" and "inf" are
/// numbers. Nothing where it is anything else. Independent of the locale.
std::optional<double> ParseDouble(std::string_view text);

/// As ParseDouble, for whole numbers that fit into a long.
std::optional<long> ParseLong(std::string_view text);

/// Numbers separated by white space. Nothing where one of them is not a number.
std::optional<std::vector<double>> ParseDoubles(std::string_view text);

}  // namespace mmm_converter
