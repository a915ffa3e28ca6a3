// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// Without blanks and control characters at both ends.
std::string_view Trim(std::string_view text);

/// ASCII letters in lower case, everything else as it is.
std::string ToLower(std::string_view text);

/// Bytes of the UTF-8 character that a text, not empty, starts with; 0: of none.
std::size_t Utf8Length(std::string_view text);

bool IsUtf8(std::string_view text);

/// As XML can hold it: bytes that are not UTF-8 taken as Latin-1, control characters as blanks.
std::string ToUtf8(std::string_view text);

/// What is between separators, each trimmed; of an empty text one that is empty.
std::vector<std::string> Split(std::string_view text, char separator);

bool EqualIgnoringCase(std::string_view a, std::string_view b);

/// A whole text as a number in C notation, white space around it allowed; "nan" and "inf" are
/// numbers. Nothing where it is anything else. Independent of the locale.
std::optional<double> ParseDouble(std::string_view text);

/// As ParseDouble, for whole numbers that fit into a long.
std::optional<long> ParseLong(std::string_view text);

/// Appends numbers separated by white space. false where one of them is not a number: it and what
/// follows is not appended.
bool AppendDoubles(std::string_view text, std::vector<double>* numbers);

/// `a, b or c`; empty for no names.
std::string JoinNames(const std::vector<std::string>& names, std::string_view last = " or ");

/// `a, b, ...`: at most that many of the names.
std::string FirstNames(const std::vector<std::string>& names, std::size_t most = 12);

}  // namespace mmm_converter
