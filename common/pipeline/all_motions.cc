// SPDX-License-Identifier: MIT
#include "common/pipeline/all_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "common/pipeline/motion_output.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"

namespace mmm_converter {
namespace {

void CheckFormat(const ConversionRequest& request, const ConverterChoice& choice,
                 const Recording& recording) {
  const std::string& format =
      request.output_format.empty() ? choice.config.output_format : request.output_format;
  if (recording.format == "MMM 2.0" && format == "2.0") return;
  throw Error(fmt::format(
      "{}: {} all converts MMM 2.0 to MMM 2.0; this would be {} to MMM {}. Name "
      "one motion ({} NAME)",
      recording.file, OptionText("motion"), recording.format, format, OptionText("motion")));
}

// Names are what tells motions that are written apart.
void CheckNames(const std::vector<WithWarnings<Recording>>& recordings) {
  std::set<std::string> names;
  for (const auto& [recording, warnings] : recordings) {
    const bool has_markers = recording.markers.num_labels() > 0;
    if (!has_markers || names.insert(recording.motion()).second) continue;
    throw Error(
        fmt::format("{}: has two motions \"{}\"; motions to convert need names of their own",
                    recording.file, recording.motion()));
  }
}

// A motion, what is planned for it (nothing where it has no markers), or why it can't be converted.
struct PlannedMotion {
  std::string name;
  std::optional<ConversionPlan> plan;
  std::string failure;
};

PlannedMotion PlanMotion(const ConversionRequest& request, const ReadBefore& read_before) {
  PlannedMotion planned;
  const Recording& recording = *read_before.motion.value;
  planned.name = recording.motion();
  if (recording.markers.num_labels() == 0) return planned;
  try {
    planned.plan = PlanConversion(request, read_before);
  } catch (const Error& error) {
    planned.failure = WithAdvice(error);
  }
  return planned;
}

// Fails what takes the model of a motion before it, as "a b" does of "a_b".
void CheckModelIsOwn(std::set<std::string>* models, PlannedMotion* planned) {
  if (!planned->plan || !planned->plan->object) return;
  const ObjectModel& object = *planned->plan->object;
  if (!object.has_motions_name || models->insert(object.file).second) return;
  planned->failure = fmt::format(
      "{}: is the model of a motion before this one; give them names that differ in letters and "
      "digits",
      object.file);
  planned->plan.reset();
}

MotionOutcome Convert(PlannedMotion planned, const std::function<bool(int, int)>& progress) {
  MotionOutcome outcome = {planned.name, std::nullopt, planned.failure};
  if (!planned.plan) return outcome;
  try {
    outcome.report = CarryOut(std::move(*planned.plan), progress);
  } catch (const Error& error) {
    outcome.failure = WithAdvice(error);
  }
  return outcome;
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
  const OpenedFiles opened;
  AllMotions all;
  std::vector<WithWarnings<Recording>> recordings =
      ReadAllMotions(request.input.file, request.input.reading, &all.warnings);
  CheckNames(recordings);
  ReadBefore read_before = {ReadModelOnce(request.input), ChooseOnce(request.converter)};
  read_before.opened = opened.files();
  std::set<std::string> models;
  std::vector<PlannedMotion> motions;
  motions.reserve(recordings.size());
  for (auto& [recording, warnings] : recordings) {
    CheckFormat(request, *read_before.choice.value, recording);
    read_before.motion = {std::make_shared<const Recording>(std::move(recording)),
                          std::move(warnings)};
    motions.push_back(PlanMotion(request, read_before));
    CheckModelIsOwn(&models, &motions.back());
  }
  std::vector<const ConversionPlan*> plans;
  for (const PlannedMotion& motion : motions) {
    if (motion.plan) plans.push_back(&*motion.plan);
  }
  if (!plans.empty()) CheckOutputs(request, plans);
  for (PlannedMotion& motion : motions) {
    all.motions.push_back(Convert(std::move(motion), progress));
  }
  const std::vector<const ConversionReport*> reports = ReportsOf(all);
  if (reports.empty()) {
    throw Error(
        fmt::format("{}: no motion could be converted{}", request.input.file, WhyNone(all)));
  }
  all.output = reports.front()->plan.output;
  return all;
}

void WriteAllMotions(const ConversionRequest& request, AllMotions* all) {
  FilesTogether files;
  std::vector<ConversionReport*> reports;
  for (MotionOutcome& outcome : all->motions) {
    if (!outcome.report) continue;
    WriteObjectModel(outcome.report->plan);
    reports.push_back(&*outcome.report);
  }
  WriteMotions(request, reports);
  files.Commit();
}

}  // namespace mmm_converter
