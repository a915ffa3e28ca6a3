// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/batch_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <new>
#include <set>
#include <thread>
#include <unordered_map>

#include "MMMConverterS2KF/batch/batch_outputs.h"
#include "MMMConverterS2KF/batch/crash_note.h"
#include "MMMConverterS2KF/batch/entry_conversion.h"
#include "MMMConverterS2KF/batch/entry_result.h"
#include "MMMConverterS2KF/batch/journal.h"
#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "MMMConverterS2KF/batch/memory_budget.h"
#include "MMMConverterS2KF/batch/persons.h"
#include "MMMConverterS2KF/terminal/interruption.h"
#include "common/pipeline/robot.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "common/support/output_plan.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string DescribeShortly(const EntryResult& result) {
  const std::size_t warnings = result.figures->warnings.size();
  const auto& robot = result.figures->robot;
  return fmt::format("{} frames, {:.1f} mm, {}{:.2f} s, {}{}", result.figures->frames,
                     result.figures->mean_mm,
                     robot && std::isfinite(robot->slide)
                         ? fmt::format("feet slide {:.1f} %, ", kPercent * robot->slide)
                         : "",
                     result.seconds, Name(result.figures->verdict.level),
                     warnings > 0 ? fmt::format(", {} warnings", warnings) : "");
}

/// Each robot once, before any recording is converted. @throws Error naming the manifest's line.
void CheckRobots(const BatchManifest& manifest, const std::vector<const BatchEntry*>& entries) {
  std::set<std::string> known;
  for (const BatchEntry* entry : entries) {
    const RobotRequest& robot = entry->request.robot;
    if (robot.file.empty()) continue;
    const std::string said = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", robot.file, robot.map_file,
                                         robot.hold, robot.weights, robot.sole,
                                         robot.sole_height.value_or(-1), robot.objects.empty());
    if (!known.insert(said).second) continue;
    try {
      ReadRobot(robot, nullptr);
    } catch (const Error& error) {
      throw Error(fmt::format("{}:{}: the robot of \"{}\" can't be used: {}", manifest.file,
                              entry->line, entry->id, error.what()),
                  error.remedy());
    }
  }
}

class BatchRunner {
 public:
  BatchRunner(const BatchManifest& manifest, const BatchOptions& options, BatchProgress* progress)
      : manifest_(manifest),
        entries_(ShardOf(manifest.entries, options.shard, options.shards)),
        options_(options),
        progress_(progress),
        folder_(options.output),
        memory_(options.memory),
        persons_(manifest, entries_, options, {&folder_, &memory_, &inputs_, progress}),
        journal_(options.output, options.shard, options.shards) {
    if (options.resume) done_ = ReadJournals(options.output);
  }

  BatchOutcome Run() {
    CheckRobots(manifest_, entries_);
    const CrashWatch watch;
    progress_->Start(static_cast<int>(entries_.size()));
    persons_.WarnOfUnused();
    std::vector<std::thread> threads;
    threads.reserve(options_.jobs);
    try {
      for (int i = 0; i < options_.jobs; ++i) threads.emplace_back([this] { Work(); });
    } catch (const std::exception&) {  // those that there are do the work
      if (threads.empty()) throw;
    }
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    outcome_.signal = InterruptionWatch::Signal();
    outcome_.seconds = progress_->Seconds();
    outcome_.not_done = static_cast<int>(entries_.size()) - outcome_.converted - outcome_.failed -
                        outcome_.unchanged;
    return outcome_;
  }

 private:
  bool IsEnding() const { return is_ending_ || InterruptionWatch::Signal() != 0; }

  void Work() {
    try {
      while (!IsEnding()) {
        const std::size_t i = next_++;
        if (i >= persons_.count() + entries_.size()) return;
        i < persons_.count() ? Calibrate(i) : Process(*entries_[i - persons_.count()]);
      }
    } catch (...) {  // even what failed can't be noted
      const std::scoped_lock lock(mutex_);
      failure_ = std::current_exception();
      is_ending_ = true;
    }
  }

  void Calibrate(std::size_t person) {
    try {
      persons_.Calibrate(person, [this] { return !IsEnding(); });
    } catch (const WriteError& error) {
      End(error.what());
    }
  }

  void Process(const BatchEntry& entry) {
    const Clock::time_point start = Clock::now();
    JournalRecord record = Begin(entry);
    CrashNote note(options_.output, options_.shard, options_.shards, record);
    std::string reason;
    bool is_tried = false;
    try {
      if (const JournalRecord* crash = FindCrash(entry, "")) return NoteCrash(*crash);
      persons_.WaitFor(entry);
      const ReadBefore read_before = inputs_.ReadFor(entry.request);
      record.fingerprint = inputs_.Fingerprint(entry, read_before);
      if (const JournalRecord* crash = FindCrash(entry, record.fingerprint)) {
        return NoteCrash(*crash);
      }
      note.Update(record);
      for (const std::string& output : folder_.OutputsOf(entry)) folder_.MakeReady(output);
      if (IsDone(entry, record.fingerprint)) return NoteUnchanged();
      is_tried = true;
      return Convert(entry, read_before, &record, &note, start);
    } catch (const WriteError& error) {
      if (error.concerns_disk()) return End(error.what());
      reason = error.what();
    } catch (const std::bad_alloc&) {
      is_tried = false;
      reason = entry.request.input.file + ": there is not enough memory for it; use fewer --jobs";
    } catch (const Error& error) {
      reason = WithManifestAdvice(error);
    } catch (const std::exception& error) {
      reason = fmt::format("{}: unexpected: {}", entry.request.input.file, error.what());
    }
    if (IsEnding()) return;  // that is why it failed
    if (is_tried) SetOutputsAside(entry);
    NoteFailed(entry, record.fingerprint, reason, SecondsSince(start));
  }

  // What was made of the recording before it changed is not what it shows now.
  void SetOutputsAside(const BatchEntry& entry) const {
    std::error_code failure;
    if (!std::filesystem::exists(entry.request.input.file, failure)) return;
    const auto found = done_.find(entry.id);
    if (found != done_.end() && found->second.result.converted() &&
        IsRecordingUnchanged(entry, found->second)) {
      return;
    }
    for (const std::string& output : folder_.OutputsOf(entry)) folder_.SetAside(output);
    folder_.SetAside(PagePath(entry.id));
  }

  JournalRecord Begin(const BatchEntry& entry) {
    JournalRecord record;
    record.id = entry.id;
    const std::scoped_lock lock(mutex_);
    record.time = journal_.NextTime();
    return record;
  }

  // What is known of an entry that ended the process of an earlier run, and would do so again.
  // fingerprint: empty: it is not known yet, and it ended the process before it was.
  const JournalRecord* FindCrash(const BatchEntry& entry, const std::string& fingerprint) const {
    const auto found = done_.find(entry.id);
    if (found == done_.end() || options_.retry_crashed) return nullptr;
    const JournalRecord& record = found->second;
    const bool is_as_then = record.crashed && record.fingerprint == fingerprint &&
                            (record.recording.hash.empty() || IsRecordingUnchanged(entry, record));
    return is_as_then ? &record : nullptr;
  }

  bool IsDone(const BatchEntry& entry, const std::string& fingerprint) const {
    const auto found = done_.find(entry.id);
    if (found == done_.end()) return false;
    const JournalRecord& record = found->second;
    std::vector<std::string> outputs = folder_.OutputsOf(entry);
    if (options_.reports.all) outputs.push_back(PagePath(entry.id));
    return record.result.converted() && record.fingerprint == fingerprint &&
           AreInputsUnchanged(entry, record) && folder_.IsComplete(record, outputs) &&
           IsRecordingUnchanged(entry, record);
  }

  // Of a recording that is not there any more there is nothing better than what was made of it.
  static bool IsRecordingUnchanged(const BatchEntry& entry, const JournalRecord& record) {
    try {
      return IsUnchanged(entry.request.input.file, record.recording);
    } catch (const Error&) {
      return true;
    }
  }

  void Convert(const BatchEntry& entry, const ReadBefore& read_before, JournalRecord* record,
               CrashNote* note, Clock::time_point start) {
    const OpenedFiles opened;
    const ConversionRequest request = RequestOf(entry, folder_);
    const std::string& file = request.input.file;
    record->recording = InspectFile(file);
    note->Update(*record);
    const std::uint64_t bytes = ConversionMemory(
        file, record->recording.bytes, options_.reports.all || !entry.request.robot.file.empty());
    const auto part = memory_.Take(file, bytes);
    std::vector<std::string> outputs = folder_.OutputsOf(entry);
    ConversionReport report = ConvertEntry(request, read_before, [this] { return !IsEnding(); });
    std::optional<RetargetReport> robot = RetargetEntry(entry, folder_, report);
    record->inputs = InspectInputs(entry, opened.files(), inputs_.FilesOf(entry, read_before));
    CheckOutputs(entry, outputs);
    FilesTogether files;
    WriteConversion(request, &report);
    if (robot) WriteRobotOutputs(entry, folder_, &*robot);
    folder_.Remove(PagePath(entry.id));  // it would show the conversion before
    if (options_.reports.all) {
      WritePage(entry, report, robot, &folder_);
      outputs.push_back(PagePath(entry.id));
    }
    files.Commit();
    for (const std::string& output : outputs) folder_.Remove(output + kOutdated);
    folder_.Remove(PagePath(entry.id) + kOutdated);
    record->outputs = folder_.Inspect(outputs);
    record->result = Converted(report, robot ? &*robot : nullptr, SecondsSince(start));
    NoteConverted(*record);
  }

  // All is read by now.
  void CheckOutputs(const BatchEntry& entry, const std::vector<std::string>& outputs) const {
    OutputPlan plan;
    for (const std::string& output : outputs) {
      plan.Rewrite(folder_.Full(output), entry.request.input.file);
    }
    plan.WriteIntoFolder(folder_.Full(PagePath(entry.id)));
    plan.Check();
  }

  void NoteUnchanged() {
    const std::scoped_lock lock(mutex_);
    ++outcome_.unchanged;
    progress_->Unchanged();
  }

  // Its line is in the journals already.
  void NoteCrash(const JournalRecord& record) {
    const std::scoped_lock lock(mutex_);
    ++outcome_.failed;
    progress_->Failed(fmt::format("{}: {}, in an earlier run; --retry-crashed tries it again",
                                  record.id, record.result.reason));
    if (options_.fail_fast) EndLocked("ended by the first failure, as --fail-fast asks for");
  }

  void NoteConverted(const JournalRecord& record) {
    const std::scoped_lock lock(mutex_);
    journal_.Append(record);
    ++outcome_.converted;
    progress_->Converted(record.id, DescribeShortly(record.result));
    const Verdict& verdict = record.result.figures->verdict;
    if (verdict.level == Verdict::Level::kFailed) {
      progress_->Warn(fmt::format("{}: verdict {}", record.id, DescribeVerdict(verdict)));
    }
  }

  void NoteFailed(const BatchEntry& entry, const std::string& fingerprint,
                  const std::string& reason, double seconds) {
    JournalRecord record;
    record.id = entry.id;
    record.fingerprint = fingerprint;
    record.result = Failed(reason, seconds);
    const std::scoped_lock lock(mutex_);
    ++outcome_.failed;
    progress_->Failed(fmt::format("{}: {}", entry.id, reason));
    try {
      journal_.Append(record);
    } catch (const WriteError& error) {
      EndLocked(error.what());
    }
    if (options_.fail_fast) EndLocked("ended by the first failure, as --fail-fast asks for");
  }

  void End(const std::string& obstacle) {
    const std::scoped_lock lock(mutex_);
    EndLocked(obstacle);
  }

  void EndLocked(const std::string& obstacle) {
    if (outcome_.obstacle.empty()) outcome_.obstacle = obstacle;
    is_ending_ = true;
  }

  const BatchManifest& manifest_;
  std::vector<const BatchEntry*> entries_;
  const BatchOptions& options_;
  BatchProgress* progress_;
  BatchFolder folder_;
  MemoryBudget memory_;
  SharedInputs inputs_;
  std::unordered_map<std::string, JournalRecord> done_;  // by id
  BatchPersons persons_;
  std::atomic<std::size_t> next_ = 0;  // of persons, then of entries
  std::atomic<bool> is_ending_ = false;
  std::mutex mutex_;  // of what follows
  Journal journal_;
  BatchOutcome outcome_;
  std::exception_ptr failure_;
};

}  // namespace

BatchOutcome ConvertBatch(const BatchManifest& manifest, const BatchOptions& options,
                          BatchProgress* progress) {
  return BatchRunner(manifest, options, progress).Run();
}

}  // namespace mmm_converter
