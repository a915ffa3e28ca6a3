// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace mmm_converter {

inline constexpr std::size_t kMaxFileBytes = std::size_t{4} << 30;

/// @throws Error where there is no such file, or it is a folder, a device or empty.
std::uint64_t RegularFileSize(const std::string& path);

/// All bytes of a file.
/// @throws Error where there is no such file, it can't be read, is a folder, empty or larger than
/// max_bytes.
std::string ReadFileContent(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

/// The first bytes of a file, at most count.
/// @throws Error as ReadFileContent.
std::string ReadFileStart(const std::string& path, std::size_t count);

}  // namespace mmm_converter
