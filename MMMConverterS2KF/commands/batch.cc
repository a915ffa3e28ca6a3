// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <utility>

#include "MMMConverterS2KF/batch/batch_run.h"
#include "MMMConverterS2KF/batch/journal.h"
#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/persons.h"
#include "MMMConverterS2KF/batch/result_files.h"
#include "MMMConverterS2KF/batch/scan.h"
#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/interruption.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/support/machine.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kMostJobs = 1024;
constexpr int kMostShards = 1000000;
constexpr double kShareOfMemory = 0.75;
constexpr int kSignalExit = 128;  // as shells say it

const std::vector<OptionGroup> kBatchOptions = {
    {"Batch",
     {{"output,o", "FOLDER", "where motions, reports, journal and results go", ""},
      {"resume", "", "keep what an earlier run has done, if nothing that it depends on has changed",
       ""},
      {"retry-crashed", "",
       "with --resume: try those again, too, that ended the process of an earlier run", ""},
      {"fail-fast", "", "end with the first recording that can't be converted", ""},
      {"reports", "WHICH",
       "pages: worst:N, the N with the largest distance; all or none; "
       "default: worst:20",
       ""}}},
    {"Work",
     {{"jobs", "N", "recordings at a time; default: all cores that this process may use", ""},
      {"memory", "SIZE", "for all jobs together, e.g. 8G; default: three quarters of what is free",
       ""},
      {"shard", "I/N", "only the I-th of N parts of the manifest, without results; see --merge",
       ""},
      {"merge", "", "convert nothing: the results of all shards, when they have ended", ""}}},
    {"Making a manifest",
     {{"scan", "FOLDER", "print a manifest of the recordings in FOLDER and below", ""},
      {"subjects", "FILE",
       "with --scan: CSV table of persons: folder (or file),height_m,mass_kg,"
       "subject_file; other columns become metadata",
       ""}}}};

constexpr const char* kBatchUsage = R"(MMMConverterS2KF batch MANIFEST -o FOLDER [options]
Converts the recordings of a manifest, an XML file ("print-config batch" prints an example). A
recording that cannot be converted does not stop the others. --resume continues a run that was
interrupted.

{}FOLDER contains motions/ID.xml, optionally reports/, csv/, robots/ and subjects/; persons/ID.xml
of each <Person>, who is calibrated once; journal.jsonl with a line for each finished recording;
results.jsonl and results.csv; index.html, sorted by quality, the worst first. The exit code is 1
if a recording failed, whatever the verdicts, and 128 + N if signal N interrupted the run; with
--strict 3 if a verdict is failed, of shards at their --merge.

Examples
  MMMConverterS2KF batch --scan recordings --subjects subjects.csv > manifest.xml
  MMMConverterS2KF batch manifest.xml -o converted
  MMMConverterS2KF batch manifest.xml -o converted --resume
  MMMConverterS2KF batch manifest.xml -o converted --resume --shard 3/16
  MMMConverterS2KF batch manifest.xml -o converted --merge
)";

ReportChoice ParseReports(const std::string& text) {
  constexpr std::string_view kWorst = "worst:";
  ReportChoice choice;
  if (text == "all") return {true, 0};
  if (text == "none") return {false, 0};
  const auto count =
      text.starts_with(kWorst) ? ParseLong(text.substr(kWorst.size())) : std::nullopt;
  if (!count || *count < 0 || *count > kMostShards) {
    throw UsageError(
        fmt::format("--reports: \"{}\" is not allowed; use worst:20, all or none", text));
  }
  choice.worst = static_cast<int>(*count);
  return choice;
}

void ParseShard(const std::string& text, BatchOptions* options) {
  const std::size_t slash = text.find('/');
  const std::string behind = slash == std::string::npos ? "" : text.substr(slash + 1);
  const long shard = ParseLong(text.substr(0, slash)).value_or(0);
  const long shards = ParseLong(behind).value_or(0);
  if (shard < 1 || shards < shard || shards > kMostShards) {
    throw UsageError(
        fmt::format("--shard: \"{}\" is not I/N; for instance 1/4, 2/4, 3/4 and 4/4", text));
  }
  options->shard = static_cast<int>(shard);
  options->shards = static_cast<int>(shards);
}

BatchOptions MakeOptions(const Arguments& arguments) {
  BatchOptions options;
  if (!arguments.Has("output")) {
    throw UsageError(
        "batch: where to? For instance: MMMConverterS2KF batch manifest.xml -o converted");
  }
  options.output = *arguments.Get("output");
  options.jobs = arguments.GetInteger("jobs", 1, kMostJobs).value_or(AvailableCores());
  options.resume = arguments.Has("resume");
  options.fail_fast = arguments.Has("fail-fast");
  options.retry_crashed = arguments.Has("retry-crashed");
  options.memory =
      static_cast<std::uint64_t>(kShareOfMemory * static_cast<double>(AvailableMemory()));
  if (const auto memory = arguments.Get("memory")) {
    const auto bytes = ParseByteSize(*memory);
    if (!bytes) {
      throw UsageError(
          fmt::format("--memory: \"{}\" is no size; for instance 800M or 8G", *memory));
    }
    options.memory = *bytes;
  }
  if (const auto reports = arguments.Get("reports")) options.reports = ParseReports(*reports);
  if (const auto shard = arguments.Get("shard")) ParseShard(*shard, &options);
  if (arguments.Has("merge") && options.shards > 1) {
    throw UsageError("batch: --merge is for all shards together; leave --shard out");
  }
  return options;
}

std::string DescribeRun(const BatchOutcome& outcome) {
  std::string text = fmt::format("{} converted, {} failed", outcome.converted, outcome.failed);
  if (outcome.unchanged > 0) text += fmt::format(", {} unchanged", outcome.unchanged);
  if (outcome.not_done > 0) text += fmt::format(", {} not done", outcome.not_done);
  text += " in " + FormatDuration(outcome.seconds);
  if (outcome.converted == 0) return text;
  const double rate = outcome.converted / std::max(outcome.seconds, 1e-3);
  return text + fmt::format(" ({:.3g} recordings a second)", rate);
}

std::string DescribeResults(const BatchManifest& manifest, const BatchOptions& options,
                            const BatchResults& results) {
  const std::filesystem::path index = std::filesystem::path(options.output) / "index.html";
  std::string text = fmt::format(
      "batch      {}: {} recordings, {} converted, {} failed, {} missing\n", manifest.name,
      manifest.entries.size(), results.converted, results.failed, results.missing);
  if (results.converted > 0) {
    text +=
        fmt::format("recorded   {} in {} frames; {:.3g} times as long as converting them took\n",
                    FormatDuration(results.recorded_seconds), results.frames,
                    results.recorded_seconds / std::max(results.seconds, 1e-3));
    text += fmt::format("distance   mean {:.1f} mm over all frames\n", results.mean_distance_mm);
    text += fmt::format("verdicts   {} good, {} to check, {} failed\n", results.good,
                        results.to_check, results.judged_failed);
  }
  return text + fmt::format("results    {}\n", index.string());
}

int ExitCodeOf(const Arguments& arguments, const BatchResults& results) {
  const auto worst = results.judged_failed > 0 ? Verdict::Level::kFailed : Verdict::Level::kGood;
  return ExitCodeOf(arguments, {worst});
}

int Merge(const BatchManifest& manifest, const BatchOptions& options, const Arguments& arguments) {
  BatchProgress progress;
  const BatchResults results = WriteBatchResults(manifest, options, &progress);
  std::cout << DescribeResults(manifest, options, results);
  return results.failed + results.missing > 0 ? 1 : ExitCodeOf(arguments, results);
}

void WarnOfEarlierRun(const std::string& folder) {
  const auto records = ReadJournals(folder);
  const auto ended = std::count_if(records.begin(), records.end(), [](const auto& record) {
    return record.second.result.converted();
  });
  if (ended == 0) return;
  LogWarning(
      fmt::format("{}: an earlier run has converted {} recordings; all are converted again, "
                  "--resume would keep "
                  "what is unchanged",
                  folder, ended));
}

int Convert(const BatchManifest& manifest, const BatchOptions& options,
            const Arguments& arguments) {
  if (!options.resume) WarnOfEarlierRun(options.output);
  BatchProgress progress;
  const InterruptionWatch watch;
  const BatchOutcome outcome = ConvertBatch(manifest, options, &progress);
  const bool was_ended = outcome.signal != 0 || !outcome.obstacle.empty();
  if (!outcome.obstacle.empty()) {
    LogError(outcome.obstacle + "; what is done stays: go on with --resume");
  } else if (was_ended) {
    LogWarning("interrupted; what is done stays: go on with --resume");
  }
  int exit_code = 0;
  if (!was_ended && options.shards == 1) {
    const BatchResults results = WriteBatchResults(manifest, options, &progress);
    exit_code = ExitCodeOf(arguments, results);
    std::cout << DescribeResults(manifest, options, results);
  }
  const std::string shard =
      options.shards > 1 ? fmt::format(" shard {}/{}:", options.shard, options.shards) : "";
  std::cout << fmt::format("run       {} {}\n", shard, DescribeRun(outcome));
  if (InterruptionWatch::Signal() != 0) return kSignalExit + InterruptionWatch::Signal();
  return was_ended || outcome.failed > 0 ? 1 : exit_code;
}

int PrintScan(const Arguments& arguments) {
  if (arguments.positional()) {
    throw UsageError(fmt::format("batch: --scan makes a manifest, {} is one; use one of them",
                                 *arguments.positional()));
  }
  const Scan scan = ScanFolder(*arguments.Get("scan"), arguments.Get("subjects").value_or(""));
  LogWarnings(scan.warnings);
  std::cout << scan.manifest;
  return 0;
}

}  // namespace

Manual BatchManual() { return {kBatchUsage, CommandOptions(task::kBatch, kBatchOptions)}; }

int RunBatch(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  if (arguments.Has("scan")) return PrintScan(arguments);
  if (!arguments.positional()) {
    throw UsageError(
        "batch: which manifest? For instance: MMMConverterS2KF batch manifest.xml -o converted; "
        "batch --scan FOLDER makes one");
  }
  const BatchOptions options = MakeOptions(arguments);
  BatchManifest manifest = ReadManifest(*arguments.positional());
  UsePersons(options.output, &manifest);
  return arguments.Has("merge") ? Merge(manifest, options, arguments)
                                : Convert(manifest, options, arguments);
}

}  // namespace mmm_converter
