// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace mmm_converter {

/// The application's JSON values; members keep the order in which they were added. Rooms hand these
/// to each other: text is made where a file is written, and parsed where one is read.
using Json = nlohmann::ordered_json;

/// A number rounded to so many decimals; null where it is not finite, which JSON can't say.
Json Number(double value, int decimals = 4);

/// null: the text is empty.
Json TextOrNull(const std::string& text);

/// Of a file that somebody else may have written.
/// @throws Error, without the file's name, where it is not JSON or is nested deeper than anything
/// that is written here.
Json ParseJson(std::string_view text);

/// A whole number of such a file. @throws Error where it is anything else or outside of the bounds.
std::int64_t ParseInteger(const Json& json, std::int64_t lowest, std::int64_t largest);

/// The text of a file, indented. Bytes that are no UTF-8, as names of files may have, are replaced.
std::string FormatJson(const Json& json);

/// The same in one line, for JSON lines and pages; without its end.
std::string FormatJsonLine(const Json& json);

}  // namespace mmm_converter
