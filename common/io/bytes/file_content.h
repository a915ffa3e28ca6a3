// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace mmm_converter {

inline constexpr std::size_t kMaxFileBytes = std::size_t{4} << 30;

/// @throws Error where there is no such file, or it is a folder, a device or empty.
std::uint64_t RegularFileSize(const std::string& path);

/// Bytes that are read part by part, so that they need not be in memory as a whole.
struct ByteSource {
  std::uint64_t size = 0;
  /// Copies the `count` bytes from byte `begin`, which must be there.
  std::function<void(std::uint64_t begin, std::size_t count, char* bytes)> read;
};

ByteSource BytesOf(std::string_view content);  ///< which must outlive it

/// The bytes of a file, which stays open and counts as read (OpenedFiles).
/// @throws Error as ReadFileContent; reading, where the file has become shorter meanwhile.
ByteSource BytesOfFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

/// All bytes of a file.
/// @throws Error where there is no such file, it can't be read, is a folder, empty or larger than
/// max_bytes.
std::string ReadFileContent(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

/// The first bytes of a file, at most count: a look at it, after which it does not count as read.
/// @throws Error as ReadFileContent.
std::string ReadFileStart(const std::string& path, std::size_t count);

}  // namespace mmm_converter
