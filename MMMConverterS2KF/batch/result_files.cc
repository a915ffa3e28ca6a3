// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/result_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "MMMConverterS2KF/batch/batch_outputs.h"
#include "MMMConverterS2KF/batch/entry_conversion.h"
#include "MMMConverterS2KF/batch/memory_budget.h"
#include "MMMConverterS2KF/report/batch_index.h"
#include "MMMConverterS2KF/terminal/interruption.h"
#include "common/support/atomic_file.h"
#include "common/support/parallel.h"

namespace mmm_converter {
namespace {

class ResultsWriter {
 public:
  ResultsWriter(const BatchManifest& manifest, const BatchOptions& options, BatchProgress* progress)
      : manifest_(manifest),
        options_(options),
        progress_(progress),
        folder_(options.output),
        memory_(options.memory),
        records_(ReadJournals(options.output)) {
    for (const BatchEntry& entry : manifest.entries) current_.push_back(Find(entry));
  }

  BatchResults Write() {
    WriteWorstPages();
    std::vector<ResultRow> rows;
    std::vector<Json> lines;
    for (std::size_t i = 0; i < current_.size(); ++i) {
      rows.push_back(Row(manifest_.entries[i], current_[i]));
    }
    SortByVerdict(&rows);
    lines.reserve(rows.size());
    for (const ResultRow& row : rows) lines.push_back(ToJson(row));
    WriteFileAtomically(folder_.Full("results.jsonl"), [&](const TextSink& sink) {
      for (const Json& line : lines) sink(FormatJsonLine(line) + "\n");
    });
    WriteFileAtomically(folder_.Full("results.csv"), FormatResultsCsv(lines));
    WriteFileAtomically(folder_.Full("index.html"), FormatBatchIndex(manifest_.name, lines));
    return Summarize(rows);
  }

 private:
  // What the journal says of an entry as it is in the manifest now; nullptr: nothing.
  const JournalRecord* Find(const BatchEntry& entry) {
    const auto found = records_.find(entry.id);
    if (found == records_.end()) return nullptr;
    const JournalRecord& record = found->second;
    if (!record.result.converted()) return &record;
    try {
      const ReadBefore read_before = inputs_.ReadFor(entry.request);
      const std::string fingerprint = inputs_.Fingerprint(entry, read_before);
      const bool is_current = record.fingerprint == fingerprint &&
                              AreInputsUnchanged(entry, record) &&
                              folder_.IsComplete(record, BatchFolder::OutputsOf(entry));
      return is_current ? &record : nullptr;
    } catch (const Error&) {
      return nullptr;
    }
  }

  ResultRow Row(const BatchEntry& entry, const JournalRecord* record) const {
    if (record == nullptr) return {&entry, std::nullopt, "", ""};
    if (!record->result.converted()) return {&entry, record->result, "", ""};
    const std::string page = PagePath(entry.id);
    const bool has_robot = !entry.request.robot.file.empty();
    return {&entry, record->result, MotionPath(entry), folder_.Has(page) ? page : "",
            has_robot ? RobotPath(entry.id) : ""};
  }

  // By verdict, then those with the largest mean distance first.
  std::vector<const BatchEntry*> Worst() const {
    using Badness = std::pair<int, double>;
    std::vector<std::pair<Badness, const BatchEntry*>> entries;
    for (std::size_t i = 0; i < current_.size(); ++i) {
      if (current_[i] == nullptr || !current_[i]->result.converted()) continue;
      const EntryFigures& figures = *current_[i]->result.figures;
      const double mean = std::isnan(figures.mean_mm) ? 0 : figures.mean_mm;
      entries.emplace_back(Badness(static_cast<int>(figures.verdict.level), mean),
                           &manifest_.entries[i]);
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const BatchEntry*> worst;
    const std::size_t count = std::min<std::size_t>(entries.size(), options_.reports.worst);
    for (std::size_t i = 0; i < count; ++i) worst.push_back(entries[i].second);
    return worst;
  }

  // Converts the worst once more, since pages need all that a conversion knows.
  void WriteWorstPages() {
    if (options_.reports.all) return;
    std::vector<const BatchEntry*> worst = Worst();
    worst.erase(std::remove_if(
                    worst.begin(), worst.end(),
                    [this](const BatchEntry* entry) { return folder_.Has(PagePath(entry->id)); }),
                worst.end());
    if (worst.empty()) return;
    progress_->Say(fmt::format("reports of the worst: {} to be made", worst.size()));
    ParallelFor(static_cast<int>(worst.size()), options_.jobs,
                [&](int i) { WritePageOf(*worst[static_cast<std::size_t>(i)]); });
  }

  void WritePageOf(const BatchEntry& entry) {
    if (InterruptionWatch::Signal() != 0) return;
    try {
      const ConversionRequest request = RequestOf(entry, folder_);
      const ReadBefore read_before = inputs_.ReadFor(request);
      const std::string& file = request.input.file;
      const std::uint64_t bytes = ConversionMemory(file, FileSize(file), true);
      const auto part = memory_.Take(file, bytes);
      const auto goes_on = [] { return InterruptionWatch::Signal() == 0; };
      const ConversionReport report = ConvertEntry(request, read_before, goes_on);
      WritePage(entry, report, RetargetEntry(entry, folder_, report), &folder_);
    } catch (const WriteError&) {
      throw;
    } catch (const Error& error) {
      progress_->Warn(fmt::format("{}: no report: {}", entry.id, error.what()));
    }
  }

  const BatchManifest& manifest_;
  const BatchOptions& options_;
  BatchProgress* progress_;
  BatchFolder folder_;
  MemoryBudget memory_;
  SharedInputs inputs_;
  std::unordered_map<std::string, JournalRecord> records_;  // by id
  std::vector<const JournalRecord*> current_;               // of each entry; nullptr: none
};

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += c;
    field += c;
  }
  field += '"';
  return field;
}

std::string CellOf(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : FormatJsonLine(value);
}

struct CsvCell {
  std::string column, text;
};

// Objects become columns "a.b", arrays one text.
void AddCells(const std::string& name, const Json& value, std::vector<CsvCell>* row) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) {
      std::string column = name;
      if (!column.empty()) column += '.';
      AddCells(column += key, part, row);
    }
  } else if (value.is_array()) {
    std::string text;
    for (const Json& part : value) text += (text.empty() ? "" : "; ") + CellOf(part);
    row->push_back({name, text});
  } else {
    row->push_back({name, CellOf(value)});
  }
}

// Columns in the order of the first row that has them; those of metadata by name, after the others.
std::vector<std::string> ColumnsOf(const std::vector<std::vector<CsvCell>>& rows) {
  std::vector<std::string> columns;
  std::set<std::string> known;
  std::set<std::string> metadata;
  for (const std::vector<CsvCell>& row : rows) {
    for (const CsvCell& cell : row) {
      if (cell.column.starts_with("metadata.")) {
        metadata.insert(cell.column);
      } else if (known.insert(cell.column).second) {
        columns.push_back(cell.column);
      }
    }
  }
  columns.insert(columns.end(), metadata.begin(), metadata.end());
  return columns;
}

std::string FormatRow(const std::vector<std::string>& texts) {
  std::string line;
  for (std::size_t i = 0; i < texts.size(); ++i) line += (i > 0 ? "," : "") + CsvField(texts[i]);
  return line + "\n";
}

}  // namespace

BatchResults WriteBatchResults(const BatchManifest& manifest, const BatchOptions& options,
                               BatchProgress* progress) {
  return ResultsWriter(manifest, options, progress).Write();
}

Json ToJson(const ResultRow& row) {
  const Json result = row.result ? ToJson(*row.result)
                                 : Json{{"state", "missing"}, {"reason", "was not converted yet"}};
  Json line = {{"id", row.entry->id},
               {"state", result.at("state")},
               {"reason", result.at("reason")},
               {"recording", row.entry->request.input.file},
               {"group", row.entry->group},
               {"metadata", row.entry->metadata},
               {"motion", TextOrNull(row.motion)},
               {"report", TextOrNull(row.report)}};
  if (!row.robot_motion.empty()) line["robot_motion"] = row.robot_motion;
  line.update(result);
  return line;
}

void SortByVerdict(std::vector<ResultRow>* rows) {
  const auto place = [](const ResultRow& row) {
    if (!row.result || !row.result->converted())
      return -1 - static_cast<int>(Verdict::Level::kFailed);
    return -static_cast<int>(row.result->figures->verdict.level);
  };
  std::stable_sort(rows->begin(), rows->end(),
                   [&](const ResultRow& a, const ResultRow& b) { return place(a) < place(b); });
}

BatchResults Summarize(const std::vector<ResultRow>& rows) {
  BatchResults sum;
  double distance = 0;
  for (const ResultRow& row : rows) {
    if (!row.result) {
      ++sum.missing;
      continue;
    }
    sum.seconds += row.result->seconds;
    if (!row.result->converted()) {
      ++sum.failed;
      continue;
    }
    const EntryFigures& figures = *row.result->figures;
    ++sum.converted;
    sum.good += figures.verdict.level == Verdict::Level::kGood ? 1 : 0;
    sum.to_check += figures.verdict.level == Verdict::Level::kCheck ? 1 : 0;
    sum.judged_failed += figures.verdict.level == Verdict::Level::kFailed ? 1 : 0;
    sum.frames += figures.frames;
    if (figures.rate > 0) sum.recorded_seconds += figures.frames / figures.rate;
    if (!std::isnan(figures.mean_mm)) distance += figures.frames * figures.mean_mm;
  }
  if (sum.frames > 0) sum.mean_distance_mm = distance / static_cast<double>(sum.frames);
  return sum;
}

std::string FormatResultsCsv(const std::vector<Json>& lines) {
  std::vector<std::vector<CsvCell>> rows(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) AddCells("", lines[i], &rows[i]);
  const std::vector<std::string> columns = ColumnsOf(rows);
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < columns.size(); ++i) places[columns[i]] = i;
  std::string csv = FormatRow(columns);
  for (const std::vector<CsvCell>& row : rows) {
    std::vector<std::string> texts(columns.size());
    for (const CsvCell& cell : row) texts[places.at(cell.column)] = cell.text;
    csv += FormatRow(texts);
  }
  return csv;
}

}  // namespace mmm_converter
