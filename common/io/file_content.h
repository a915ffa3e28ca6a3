// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace mmm_converter {

inline constexpr std::size_t kMaxFileBytes = std::size_t{4} << 30;

/// All bytes of a file.
/// @throws Error where there is no such file, it can't be read, is a folder, empty or larger than
/// max_bytes.
std::string ReadFileContent(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

}  // namespace mmm_converter
