// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/support/content_hash.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kBegin = "journal";
constexpr const char* kEnd = ".jsonl";

std::optional<JournalRecord> ParseRecord(std::string_view line) {
  try {
    const Json json = Json::parse(line);
    JournalRecord record;
    record.id = json.at("id").get<std::string>();
    record.converted = json.at("converted").get<bool>();
    record.fingerprint = json.at("fingerprint").get<std::string>();
    const Json& recording = json.at("recording");
    record.recording = {recording.at("bytes").get<std::uint64_t>(),
                        recording.at("modified_ns").get<std::int64_t>(),
                        recording.at("hash").get<std::string>()};
    record.outputs = json.at("outputs").get<std::map<std::string, std::uint64_t>>();
    record.result = json.at("result").dump();
    return record;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::string Journal::JournalFile(const std::string& folder, int shard, int shards) {
  const std::string part = shards == 1 ? "" : fmt::format(".{}of{}", shard, shards);
  return (fs::path(folder) / (kBegin + part + kEnd)).string();
}

void Journal::Append(const JournalRecord& record) {
  const Json line = {{"id", record.id},
                     {"converted", record.converted},
                     {"fingerprint", record.fingerprint},
                     {"recording",
                      {{"bytes", record.recording.bytes},
                       {"modified_ns", record.recording.modified},
                       {"hash", record.recording.hash}}},
                     {"outputs", record.outputs},
                     {"result", Json::parse(record.result)}};
  file_.Append(line.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void ReadJournals(const std::string& folder, const std::function<void(JournalRecord)>& visit) {
  std::vector<std::pair<fs::file_time_type, std::string>> files;
  std::error_code failure;
  for (fs::directory_iterator file(folder, failure), end; !failure && file != end;
       file.increment(failure)) {
    const std::string name = file->path().filename().string();
    if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) continue;
    files.emplace_back(fs::last_write_time(file->path(), failure), file->path().string());
  }
  if (failure) throw Error(fmt::format("{}: can't be read: {}", folder, failure.message()));
  std::sort(files.begin(), files.end());
  for (const auto& [time, file] : files) {
    ForEachLine(file, [&](std::string_view line) {
      if (auto record = ParseRecord(line)) visit(std::move(*record));
    });
  }
}

RecordedFile InspectFile(const std::string& path) {
  std::error_code failure;
  RecordedFile file;
  file.bytes = fs::file_size(path, failure);
  if (failure) throw Error(fmt::format("{}: can't be read: {}", path, failure.message()));
  const auto modified = fs::last_write_time(path, failure).time_since_epoch();
  if (failure) throw Error(fmt::format("{}: can't be read: {}", path, failure.message()));
  file.modified = std::chrono::duration_cast<std::chrono::nanoseconds>(modified).count();
  return file;
}

bool IsUnchanged(const std::string& path, const RecordedFile& recorded) {
  const RecordedFile now = InspectFile(path);
  if (now.bytes != recorded.bytes) return false;
  return now.modified == recorded.modified || HashFile(path) == recorded.hash;
}

}  // namespace mmm_converter
