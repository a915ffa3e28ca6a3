// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/file_state.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "common/support/content_hash.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const std::string& path, const std::error_code& failure) {
  throw Error(fmt::format("{}: can't be read: {}", path, failure.message()));
}

std::int64_t ModifiedTime(const std::string& path) {
  std::error_code failure;
  const auto time = fs::last_write_time(path, failure).time_since_epoch();
  if (failure) Fail(path, failure);
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
}

}  // namespace

FileState InspectFile(const std::string& path) {
  return {FileSize(path), ModifiedTime(path), HashFile(path)};
}

bool IsUnchanged(const std::string& path, const FileState& state) {
  if (FileSize(path) != state.bytes) return false;
  return ModifiedTime(path) == state.modified || HashFile(path) == state.hash;
}

std::uint64_t FileSize(const std::string& path) {
  std::error_code failure;
  const std::uint64_t bytes = fs::file_size(path, failure);
  if (failure) Fail(path, failure);
  return bytes;
}

}  // namespace mmm_converter
