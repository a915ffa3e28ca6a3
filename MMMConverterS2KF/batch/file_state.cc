// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/file_state.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

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

Json ToJson(const FileState& state) {
  return {{"bytes", state.bytes}, {"modified_ns", state.modified}, {"hash", state.hash}};
}

Json ToJson(const std::map<std::string, FileState>& states) {
  Json json = Json::object();
  for (const auto& [path, state] : states) json[path] = ToJson(state);
  return json;
}

FileState ParseFileState(const Json& json) {
  return {static_cast<std::uint64_t>(ParseInteger(json.at("bytes"), 0, INT64_MAX)),
          ParseInteger(json.at("modified_ns"), INT64_MIN, INT64_MAX),
          json.at("hash").get<std::string>()};
}

std::map<std::string, FileState> ParseFileStates(const Json& json) {
  std::map<std::string, FileState> states;
  for (const auto& [path, state] : json.items()) states[path] = ParseFileState(state);
  return states;
}

std::uint64_t FileSize(const std::string& path) {
  std::error_code failure;
  const std::uint64_t bytes = fs::file_size(path, failure);
  if (failure) Fail(path, failure);
  return bytes;
}

}  // namespace mmm_converter
