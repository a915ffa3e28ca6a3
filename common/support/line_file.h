// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace mmm_converter {

/// A text file to which whole lines are added, each on the disk before Append returns. One process
/// at a time has it.
class LineFile {
 public:
  /// Creates or opens the file, and changes nothing of what is in it.
  /// @throws Error naming the system's reason, and where it is a link or no regular file, or
  /// another process has it.
  explicit LineFile(const std::string& path);
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  /// Whole or not at all. Before the first one a last line without its end, from a process that was
  /// killed in it, is cut off. Not for several threads at a time.
  /// @throws WriteError; the file is then as it was.
  void Append(std::string_view line);

 private:
  void CutOffPartOfLine();

  std::string path_;
  int descriptor_ = -1;
  long size_ = -1;  // [bytes] of whole lines; -1 before the first Append
};

/// Of a longer line ForEachLine gives that much.
inline constexpr std::size_t kMostLineBytes = std::size_t{64} << 20;

/// Calls visit for each whole line of a file, without its end; nothing where there is no such file.
/// @throws Error where it can't be read or is not a regular file.
void ForEachLine(const std::string& path, const std::function<void(std::string_view)>& visit);

/// The first bytes of a file, at most so many; none where it can't be read.
std::string FirstBytes(const std::string& path, std::size_t most);

}  // namespace mmm_converter
