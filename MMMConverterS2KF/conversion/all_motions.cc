// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/all_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "MMMConverterS2KF/conversion/motion_output.h"
#include "common/support/error.h"
#include "common/support/output_plan.h"

namespace mmm_converter {
namespace {

ConversionRequest RequestFor(const ConversionRequest& request, Recording recording,
                             const std::shared_ptr<const ConverterChoice>& choice) {
  ConversionRequest own = request;
  own.input.reading.motion = recording.motion;
  own.input.recording = std::make_shared<const Recording>(std::move(recording));
  own.choice = choice;
  own.motion_name.clear();
  own.is_one_of_all = true;
  return own;
}

void CheckFormat(const ConversionRequest& request, const ConverterChoice& choice,
                 const Recording& recording) {
  const std::string& format =
      request.output_format.empty() ? choice.config.output_format : request.output_format;
  if (recording.format == "MMM 2.0" && format == "2.0") return;
  throw Error(
      fmt::format("{}: --motion all converts MMM 2.0 to MMM 2.0; this would be {} to MMM {}. Name "
                  "one motion (--motion NAME)",
                  recording.file, recording.format, format));
}

MotionOutcome ConvertOne(const ConversionRequest& request,
                         const std::function<bool(int, int)>& progress) {
  MotionOutcome outcome;
  outcome.name = request.input.recording->motion;
  if (request.input.recording->markers.num_labels() == 0) return outcome;
  try {
    outcome.report = RunConversion(request, progress);
  } catch (const Error& error) {
    outcome.failure = error.what();
  }
  return outcome;
}

// Names are what tells motions that are written apart.
void CheckNames(const std::vector<Recording>& recordings) {
  std::set<std::string> names;
  for (const Recording& recording : recordings) {
    const bool has_markers = recording.markers.num_labels() > 0;
    if (!has_markers || names.insert(recording.motion).second) continue;
    throw Error(
        fmt::format("{}: has two motions \"{}\"; motions to convert need names of their own",
                    recording.file, recording.motion));
  }
}

// Fails what takes the model of a motion before it, as "a b" does of "a_b".
void CheckModelIsOwn(std::set<std::string>* models, MotionOutcome* outcome) {
  if (!outcome->report || !outcome->report->object) return;
  const ConversionReport& report = *outcome->report;
  if (!report.object->has_motions_name || models->insert(report.input.model_file).second) return;
  outcome->failure = fmt::format(
      "{}: is the model of a motion before this one; give them names that differ in letters and "
      "digits",
      report.input.model_file);
  outcome->report.reset();
}

std::string WhyNone(const AllMotions& all) {
  std::string reasons;
  for (const MotionOutcome& outcome : all.motions) {
    if (!outcome.failure.empty()) {
      reasons += fmt::format("\n{}: {}", outcome.name, outcome.failure);
    }
  }
  return reasons.empty() ? ": none has markers" : reasons;
}

}  // namespace

std::vector<const ConversionReport*> ReportsOf(const AllMotions& all) {
  std::vector<const ConversionReport*> reports;
  for (const MotionOutcome& outcome : all.motions) {
    if (outcome.report) reports.push_back(&*outcome.report);
  }
  return reports;
}

AllMotions RunAllMotions(const ConversionRequest& request,
                         const std::function<bool(int, int)>& progress) {
  OutputPlan outputs;
  outputs.Write(request.output);
  for (const std::string& output : request.more_outputs) outputs.Write(output);
  outputs.Check();
  AllMotions all;
  std::vector<Recording> recordings =
      ReadAllMotions(request.input.file, request.input.reading, &all.warnings);
  const auto choice = std::make_shared<const ConverterChoice>(ChooseConverter(request.converter));
  CheckNames(recordings);
  ConversionRequest of_each = request;
  of_each.input.model = ReadModel(request.input).model;
  std::set<std::string> models;
  for (Recording& recording : recordings) {
    CheckFormat(request, *choice, recording);
    MotionOutcome outcome = ConvertOne(RequestFor(of_each, std::move(recording), choice), progress);
    CheckModelIsOwn(&models, &outcome);
    all.motions.push_back(std::move(outcome));
  }
  const std::vector<const ConversionReport*> reports = ReportsOf(all);
  if (reports.empty()) {
    throw Error(
        fmt::format("{}: no motion could be converted{}", request.input.file, WhyNone(all)));
  }
  CheckOutputs(request, reports);
  all.output = reports.front()->output;
  return all;
}

void WriteAllMotions(const ConversionRequest& request, AllMotions* all) {
  std::vector<ConversionReport*> reports;
  for (MotionOutcome& outcome : all->motions) {
    if (!outcome.report) continue;
    WriteObjectModel(*outcome.report);
    reports.push_back(&*outcome.report);
  }
  WriteMotions(request, reports);
}

}  // namespace mmm_converter
