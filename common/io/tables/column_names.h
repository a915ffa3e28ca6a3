// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// A text as one word of a table's header: blanks and control characters as '_'; "unnamed" where it
/// is empty.
std::string OneWord(std::string_view text);

/// A text as UTF-8 that needs no quotes in CSV or JSON: '_' for quotes, backslashes, commas and
/// semicolons, blanks for control characters.
std::string PlainCell(std::string_view text);

/// The names as words, each of them once: where a name was there before, "_2" or the next number
/// that is free is appended.
std::vector<std::string> ColumnNames(const std::vector<std::string>& names);

/// The same for tables whose cells commas separate: each a PlainCell, too.
std::vector<std::string> CsvColumnNames(std::vector<std::string> names);

}  // namespace mmm_converter
