// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "MMMConverterS2KF/report/json.h"

namespace mmm_converter {

/// A file as it was.
struct FileState {
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  ///< [ns]
  std::string hash;           ///< ContentHash of its bytes
};

/// @throws Error where it can't be read.
FileState InspectFile(const std::string& path);

/// Whether the file is as it was: the same size and time, or else the same size and hash.
/// @throws Error where it can't be read.
bool IsUnchanged(const std::string& path, const FileState& state);

/// As journals have it.
Json ToJson(const FileState& state);
Json ToJson(const std::map<std::string, FileState>& states);  ///< by path

/// @throws nlohmann::json::exception or Error where it is something else.
FileState ParseFileState(const Json& json);
std::map<std::string, FileState> ParseFileStates(const Json& json);

/// [bytes] @throws Error where there is none.
std::uint64_t FileSize(const std::string& path);

}  // namespace mmm_converter
