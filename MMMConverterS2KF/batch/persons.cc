// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/persons.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "MMMConverterS2KF/batch/file_state.h"
#include "MMMConverterS2KF/batch/manifest_attributes.h"
#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/osim_scaling_summary.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mmm/subject_file.h"
#include "common/pipeline/osim_scaling_run.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/atomic_file.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxNoteBytes = std::size_t{16} << 20;

bool IsOfOsim(const BatchPerson& person) {
  try {
    return IsOsimModel(person.settings.request.input);
  } catch (const Error&) {  // its calibration will say so
    return false;
  }
}

// The calibration's summary, with what it depended on.
std::string NotePath(const BatchPerson& person) { return "persons/" + person.id + ".json"; }

CalibrationRequest RequestOf(const BatchPerson& person) {
  CalibrationRequest request;
  for (const std::string& file : person.recordings) {
    request.inputs.push_back(person.settings.request.input);
    request.inputs.back().file = file;
  }
  request.converter = person.settings.request.converter;
  request.name = person.id;
  return request;
}

struct CalibratedPerson {
  std::string content;  // of its file
  Json summary;
  CalibrationResult result;
  Verdict verdict;
  std::size_t warnings = 0;
};

CalibratedPerson CalibrateOne(const BatchPerson& person, const ConverterChoice& choice,
                              const std::function<bool()>& goes_on) {
  const auto progress = [&](int, int) {
    if (!goes_on()) throw Error("interrupted");
  };
  const CalibrationRequest request = RequestOf(person);
  const std::string file = PersonPath(person);
  if (IsOfOsim(person)) {
    OsimScalingReport report = RunOsimCalibration(request, {choice.config, {}}, progress);
    return {std::move(report.scaled.content), ToJson(report, file), *report.result, *report.verdict,
            report.warnings.texts().size()};
  }
  CalibrationReport report = RunCalibration(request, {choice.config, {}}, progress);
  return {FormatSubject(report.result.subject, SubjectProgram()), ToJson(report, file),
          report.result, report.verdict, report.warnings.texts().size()};
}

std::string DescribePerson(const BatchPerson& person, const CalibratedPerson& done) {
  return fmt::format("person {}: calibrated by {} recording{}, {:.1f} mm, {}{}", person.id,
                     person.recordings.size(), person.recordings.size() == 1 ? "" : "s",
                     kMillimetres * done.result.distance_after, Name(done.verdict.level),
                     done.warnings > 0 ? fmt::format(", {} warnings", done.warnings) : "");
}

// Of a recording that is not there any more there is nothing better than what was made of it.
bool IsUnchangedOrGone(const std::string& file, const FileState& state) {
  std::error_code failure;
  return !std::filesystem::exists(file, failure) || IsUnchanged(file, state);
}

}  // namespace

std::string PersonPath(const BatchPerson& person) {
  return "persons/" + person.id + (IsOfOsim(person) ? ".osim" : ".xml");
}

void UsePersons(const std::string& output, BatchManifest* manifest) {
  std::map<std::string, std::string> files;
  for (const auto& [id, person] : manifest->persons) {
    files[id] = (std::filesystem::path(output) / PersonPath(person)).string();
  }
  for (BatchEntry& entry : manifest->entries) {
    if (entry.person.empty()) continue;
    InputRequest* input = &entry.request.input;
    const std::string& file = files.at(entry.person);
    if (file.ends_with(".osim")) {
      input->model_file = file;
      input->marker_file.clear();  // the model has them, where the person wears them
    } else {
      input->person.subject_file = file;
    }
  }
}

BatchPersons::BatchPersons(const BatchManifest& manifest,
                           const std::vector<const BatchEntry*>& entries,
                           const BatchOptions& options, const BatchTools& tools)
    : manifest_(manifest), resume_(options.resume), tools_(tools) {
  for (const BatchEntry* entry : entries) {
    if (entry->person.empty() || !states_.emplace(entry->person, State()).second) continue;
    persons_.push_back(&manifest.persons.at(entry->person));
  }
}

void BatchPersons::WarnOfUnused() const {
  std::set<std::string> used;
  for (const BatchEntry& entry : manifest_.entries) used.insert(entry.person);
  for (const auto& [id, person] : manifest_.persons) {
    if (used.count(id) > 0) continue;
    tools_.progress->Warn(fmt::format("{}:{}: no recording has person=\"{}\"; it is not calibrated",
                                      manifest_.file, person.line, id));
  }
}

void BatchPersons::Calibrate(std::size_t i, const std::function<bool()>& goes_on) {
  const BatchPerson& person = *persons_[i];
  try {
    Run(person, goes_on);
    End(person, "");
  } catch (const WriteError& error) {
    End(person, error.what());
    if (error.concerns_disk()) throw;
  } catch (const std::bad_alloc&) {
    End(person, "there is not enough memory for it; use fewer --jobs");
  } catch (const Error& error) {
    End(person, WithManifestAdvice(error));
  } catch (const std::exception& error) {
    End(person, fmt::format("unexpected: {}", error.what()));
  }
}

void BatchPersons::WaitFor(const BatchEntry& entry) {
  if (entry.person.empty()) return;
  std::unique_lock lock(mutex_);
  const State& state = states_.at(entry.person);
  ended_.wait(lock, [&] { return state.has_ended; });
  if (state.failure.empty()) return;
  throw Error(fmt::format("{}:{}: <Person id=\"{}\"> can't be calibrated: {}", manifest_.file,
                          manifest_.persons.at(entry.person).line, entry.person, state.failure));
}

void BatchPersons::Run(const BatchPerson& person, const std::function<bool()>& goes_on) {
  const ReadBefore read_before = tools_.inputs->ReadFor(person.settings.request);
  const ConverterChoice& choice = *read_before.choice.value;
  const std::string fingerprint = tools_.inputs->Fingerprint(person.settings, read_before);
  const std::string file = PersonPath(person);
  tools_.folder->MakeReady(file);
  if (resume_ && IsDone(person, fingerprint)) return;
  Json recordings = Json::array();
  std::uint64_t bytes = 0;
  for (const std::string& recording : person.recordings) {
    recordings.push_back(ToJson(InspectFile(recording)));
    bytes += ConversionMemory(recording, FileSize(recording), false);
  }
  const auto part = tools_.memory->Take(person.recordings.front(), bytes);
  CalibratedPerson done = CalibrateOne(person, choice, goes_on);
  WriteFileAtomically(tools_.folder->Full(file), done.content);
  done.summary["fingerprint"] = fingerprint;
  done.summary["recording_states"] = recordings;
  done.summary["outputs"] = ToJson(tools_.folder->Inspect({file}));
  WriteFileAtomically(tools_.folder->Full(NotePath(person)), FormatJson(done.summary));
  tools_.progress->Say(DescribePerson(person, done));
  if (done.verdict.level != Verdict::Level::kGood) {
    tools_.progress->Warn(
        fmt::format("person {}: verdict {}", person.id, DescribeVerdict(done.verdict)));
  }
}

bool BatchPersons::IsDone(const BatchPerson& person, const std::string& fingerprint) const {
  if (!tools_.folder->Has(NotePath(person))) return false;
  try {
    const Json note =
        ParseJson(ReadFileContent(tools_.folder->Full(NotePath(person)), kMaxNoteBytes));
    JournalRecord record;
    record.outputs = ParseFileStates(note.at("outputs"));
    const Json& states = note.at("recording_states");
    bool is_done = note.at("fingerprint").get<std::string>() == fingerprint &&
                   states.size() == person.recordings.size() &&
                   tools_.folder->IsComplete(record, {PersonPath(person)});
    for (std::size_t i = 0; is_done && i < person.recordings.size(); ++i) {
      is_done = IsUnchangedOrGone(person.recordings[i], ParseFileState(states.at(i)));
    }
    return is_done;
  } catch (const nlohmann::json::exception&) {
    return false;
  } catch (const Error&) {
    return false;
  }
}

void BatchPersons::End(const BatchPerson& person, const std::string& failure) {
  const std::scoped_lock lock(mutex_);
  states_[person.id] = {true, failure};
  ended_.notify_all();
}

}  // namespace mmm_converter
