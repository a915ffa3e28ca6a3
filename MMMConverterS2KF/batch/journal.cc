// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/support/error.h"
#include "common/support/folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBegin = "journal";
constexpr const char* kEnd = ".jsonl";
constexpr std::int64_t kYear10000 = 253402300800000;  // [ms since 1970]

std::int64_t ParseTime(const Json& json) { return ParseInteger(json, INT64_MIN, INT64_MAX); }

std::optional<JournalRecord> ParseRecord(std::string_view line) {
  try {
    const Json json = ParseJson(line);
    JournalRecord record;
    record.id = json.at("id").get<std::string>();
    record.time = ParseTime(json.at("time_ms"));
    record.fingerprint = json.at("fingerprint").get<std::string>();
    record.recording = ParseFileState(json.at("recording"));
    if (json.contains("inputs")) record.inputs = ParseFileStates(json.at("inputs"));
    record.outputs = ParseFileStates(json.at("outputs"));
    record.result = ParseEntryResult(json.at("result"));
    record.crashed = json.value("crashed", false);
    return record;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void ForEachJournal(const std::string& folder,
                    const std::function<void(const std::string&)>& visit) {
  std::error_code failure;
  if (!fs::exists(folder, failure)) return;
  const std::vector<std::string> names = NamesIn(folder, &failure);
  for (const std::string& name : names) {
    if (name.starts_with(kBegin) && name.ends_with(kEnd)) visit((fs::path(folder) / name).string());
  }
  if (failure) throw Error(fmt::format("{}: can't be read: {}", folder, failure.message()));
}

// Lines are added to a journal, not to a file of another kind that has its name.
void CheckIsJournal(const std::string& file) {
  const std::string first = FirstBytes(file, 1);
  if (first.empty() || first == "{" || first == "[") return;
  throw Error(
      fmt::format("{}: is no journal of a batch, which has a JSON text in each line; move it "
                  "away, or give another output folder",
                  file));
}

// Each journal's last record is its latest.
std::int64_t LatestTime(const std::string& folder) {
  std::int64_t latest = 0;
  ForEachJournal(folder, [&](const std::string& file) {
    std::string last;
    ForEachLine(file, [&](std::string_view line) { last = line; });
    const auto record = ParseRecord(last);
    if (record && record->time < kYear10000) latest = std::max(latest, record->time);
  });
  return latest;
}

}  // namespace

Journal::Journal(const std::string& folder, int shard, int shards)
    : file_(JournalFile(folder, shard, shards)), latest_(LatestTime(folder)) {
  CheckIsJournal(JournalFile(folder, shard, shards));
}

std::int64_t Journal::NextTime() const {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::max<std::int64_t>(latest_ + 1,
                                std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

void Journal::Append(JournalRecord record) {
  record.time = latest_ = NextTime();
  file_.Append(FormatJournalLine(record));
}

std::string JournalFile(const std::string& folder, int shard, int shards, const std::string& kind) {
  const std::string part = shards == 1 ? "" : fmt::format(".{}of{}", shard, shards);
  return (fs::path(folder) / (kBegin + part + kind + kEnd)).string();
}

std::string FormatJournalLine(const JournalRecord& record) {
  Json line = {{"id", record.id},
               {"time_ms", record.time},
               {"converted", record.result.converted()},
               {"fingerprint", record.fingerprint},
               {"recording", ToJson(record.recording)},
               {"outputs", ToJson(record.outputs)},
               {"result", ToJson(record.result)}};
  if (!record.inputs.empty()) line["inputs"] = ToJson(record.inputs);
  if (record.crashed) line["crashed"] = true;
  return FormatJsonLine(line);
}

std::unordered_map<std::string, JournalRecord> ReadJournals(const std::string& folder) {
  std::unordered_map<std::string, JournalRecord> latest;
  const auto take = [&](std::string_view line) {
    std::optional<JournalRecord> record = ParseRecord(line);
    if (!record) return;
    JournalRecord& known = latest[record->id];
    if (record->time >= known.time) known = std::move(*record);
  };
  ForEachJournal(folder, [&](const std::string& file) { ForEachLine(file, take); });
  return latest;
}

}  // namespace mmm_converter
