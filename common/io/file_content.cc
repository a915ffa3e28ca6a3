// SPDX-License-Identifier: MIT
#include "common/io/file_content.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "common/support/error.h"

namespace mmm_converter {

std::uint64_t RegularFileSize(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw Error(fmt::format("{}: no such file", path));
  }
  if (std::filesystem::is_directory(status)) {
    throw Error(fmt::format("{}: is a folder; give a file", path));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(fmt::format("{}: is not a regular file or can't be reached", path));
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Error(fmt::format("{}: can't be read: {}", path, error.message()));
  if (size == 0) throw Error(fmt::format("{}: the file is empty", path));
  return size;
}

std::string ReadFileContent(const std::string& path, std::size_t max_bytes) {
  const std::uint64_t size = RegularFileSize(path);
  if (size > max_bytes) {
    throw Error(fmt::format("{}: has {} bytes, more than the {} that are read at most", path, size,
                            max_bytes));
  }
  return ReadFileStart(path, size);
}

std::string ReadFileStart(const std::string& path, std::size_t count) {
  std::string content(std::min<std::uint64_t>(count, RegularFileSize(path)), '\0');
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw Error(fmt::format("{}: can't be opened: {}", path, std::strerror(errno)));
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  if (std::fread(content.data(), 1, content.size(), file.get()) != content.size()) {
    throw Error(fmt::format("{}: can't be read to its end", path));
  }
  return content;
}

}  // namespace mmm_converter
