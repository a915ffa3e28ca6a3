// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace mmm_converter {

// Of std::filesystem's iterators some members that promise not to throw allocate in libstdc++ 12:
// short of memory, they end the program.

/// Names of all that is in a folder but . and .., sorted. failure: why it can't be read, or not
/// all of it.
std::vector<std::string> NamesIn(const std::string& folder, std::error_code* failure = nullptr);

/// Paths of what has this ending (".xml"), sorted. A folder that can't be read has nothing.
std::vector<std::string> FilesIn(const std::string& folder, std::string_view ending);

/// The same as names without folder and ending.
std::vector<std::string> StemsIn(const std::string& folder, std::string_view ending);

}  // namespace mmm_converter
