// SPDX-License-Identifier: MIT
#include "common/io/bytes/file_content.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>

#include "common/support/error.h"
#include "common/support/opened_files.h"

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

ByteSource BytesOf(std::string_view content) {
  return {content.size(), [content](std::uint64_t begin, std::size_t count, char* bytes) {
            content.copy(bytes, count, begin);
          }};
}

namespace {

ByteSource Opened(const std::string& path, std::size_t max_bytes) {
  const std::uint64_t size = RegularFileSize(path);
  if (size > max_bytes) {
    throw Error(fmt::format("{}: has {} bytes, more than the {} that are read at most", path, size,
                            max_bytes));
  }
  const std::shared_ptr<std::FILE> file(std::fopen(path.c_str(), "rb"), [](std::FILE* opened) {
    if (opened != nullptr) std::fclose(opened);
  });
  if (!file) throw Error(fmt::format("{}: can't be opened: {}", path, std::strerror(errno)));
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  return {size, [path, file](std::uint64_t begin, std::size_t count, char* bytes) {
            if (std::fseek(file.get(), static_cast<long>(begin), SEEK_SET) != 0 ||
                std::fread(bytes, 1, count, file.get()) != count) {
              throw Error(fmt::format("{}: can't be read to its end", path));
            }
          }};
}

}  // namespace

ByteSource BytesOfFile(const std::string& path, std::size_t max_bytes) {
  ByteSource file = Opened(path, max_bytes);
  OpenedFiles::Note(path);
  return file;
}

std::string ReadFileContent(const std::string& path, std::size_t max_bytes) {
  const ByteSource file = BytesOfFile(path, max_bytes);
  std::string content(file.size, '\0');
  file.read(0, content.size(), content.data());
  return content;
}

std::string ReadFileStart(const std::string& path, std::size_t count) {
  const ByteSource file = Opened(path, std::numeric_limits<std::size_t>::max());
  std::string content(std::min<std::uint64_t>(count, file.size), '\0');
  file.read(0, content.size(), content.data());
  return content;
}

}  // namespace mmm_converter
