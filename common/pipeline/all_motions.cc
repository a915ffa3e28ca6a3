// SPDX-License-Identifier: MIT
#include "common/pipeline/all_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <unordered_set>
#include <utility>

#include "common/motion/body_contacts.h"
#include "common/pipeline/ground_study.h"
#include "common/pipeline/motion_output.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

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

// Estimated heights of one person are not so far apart.
constexpr double kSamePerson = 0.05;  // [m]
// Frames of a standing person may be alike by chance, rounded as they are stored.
constexpr int kFewestShared = 10;
constexpr int kFewestLabels = 4;

std::string DoubtOfPersons(const std::vector<const ConversionReport*>& reports,
                           const std::vector<std::string>& names) {
  double least = HUGE_VAL, most = 0;
  std::vector<std::string> heights;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const Person& person = reports[i]->plan.person;
    if (reports[i]->plan.object || person.subject || !(person.height.value > 0)) continue;
    least = std::min(least, person.height.value);
    most = std::max(most, person.height.value);
    heights.push_back(fmt::format("{} {:.2f}", names[i], person.height.value));
  }
  if (heights.size() < 2 || most - least < kSamePerson) return "";
  return fmt::format(
      "the persons of these recordings are {:.2f} to {:.2f} m tall ({}): strides of all together "
      "are of several persons, if these heights are right",
      least, most, FirstNames(heights, 8));
}

// Of its strides; nothing: it has none.
std::optional<GaitKind> GaitKindOf(const ConversionReport& report) {
  if (report.plan.object || !HasFeet(*report.plan.setup.model)) return std::nullopt;
  try {
    const auto ground = StudyGround(report);
    const Gait gait = ground->gait ? *ground->gait
                                   : AnalyzeGait(ground->feet, ground->steps, AnatomicalAngles(),
                                                 FindKnownLegs(report));
    if (gait.strides.empty()) return std::nullopt;
    return gait.kind;
  } catch (const Error&) {  // the file may be elsewhere by now
    return std::nullopt;
  }
}

// Of recordings of one condition, strides of which are averaged.
void AddDoubtsOfKinds(const std::vector<const ConversionReport*>& reports,
                      const std::vector<std::string>& names, std::vector<std::string>* doubts) {
  std::map<std::string, std::map<GaitKind, std::vector<std::string>>> kinds;
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const auto kind = GaitKindOf(*reports[i]);
    if (kind) kinds[reports[i]->plan.patient.condition][*kind].push_back(names[i]);
  }
  for (const auto& [condition, of_kinds] : kinds) {
    if (of_kinds.size() < 2) continue;
    std::vector<std::string> texts;
    for (const auto& [kind, own] : of_kinds) {
      texts.push_back(fmt::format("{} ({})", Name(kind), FirstNames(own, 8)));
    }
    doubts->push_back(fmt::format("strides of all together are of {}; give each a {} of its own",
                                  JoinNames(texts, " and of "), OptionText("condition")));
  }
}

int SharedFrames(const MarkerSequence& a, const MarkerSequence& b) {
  std::vector<int> of_a, of_b;
  for (int i = 0; i < a.num_labels(); ++i) {
    const int j = b.FindLabel(a.labels()[static_cast<std::size_t>(i)]);
    if (j < 0) continue;
    of_a.push_back(i);
    of_b.push_back(j);
  }
  std::string bytes;
  // 0: too little is seen.
  const auto hash = [&](const MarkerSequence& markers, const std::vector<int>& columns, int k) {
    bytes.clear();
    int seen = 0;
    for (const int column : columns) {
      const Eigen::Vector3d p = markers.frame(k).col(column);
      if (IsSeen(p)) ++seen;
      bytes += IsSeen(p) ? std::string(reinterpret_cast<const char*>(p.data()), sizeof(double) * 3)
                         : "-";
    }
    return seen < kFewestLabels ? std::size_t{0} : std::hash<std::string>()(bytes);
  };
  std::unordered_set<std::size_t> frames;
  for (int k = 0; k < a.num_frames(); ++k) frames.insert(hash(a, of_a, k));
  int shared = 0;
  for (int k = 0; k < b.num_frames(); ++k) {
    const std::size_t frame = hash(b, of_b, k);
    if (frame != 0 && frames.contains(frame)) ++shared;
  }
  return shared;
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

std::vector<std::string> NamesOfReports(const std::vector<const ConversionReport*>& reports) {
  const auto file_of = [](const ConversionReport* one) {
    return fs::path(one->plan.input.recording.file);
  };
  std::map<std::string, int> stems, files;
  for (const ConversionReport* one : reports) {
    ++stems[file_of(one).stem().string()];
    ++files[file_of(one).string()];
  }
  std::map<std::string, int> count;
  std::vector<std::string> names;
  for (const ConversionReport* one : reports) {
    const fs::path file = file_of(one);
    const std::string folder = fs::absolute(file).parent_path().filename().string();
    std::string name = file.stem().string();
    if (files[file.string()] > 1) {
      name = one->plan.motion_name;
    } else if (stems[name] > 1) {
      name.insert(0, folder + "/");
    }
    const int number = ++count[name];
    names.push_back(number > 1 ? fmt::format("{} ({})", name, number) : name);
  }
  return names;
}

std::vector<std::string> DoubtsTogether(const std::vector<const ConversionReport*>& reports) {
  std::vector<std::string> doubts;
  if (reports.size() < 2) return doubts;
  const std::vector<std::string> names = NamesOfReports(reports);
  if (std::string doubt = DoubtOfPersons(reports, names); !doubt.empty()) {
    doubts.push_back(std::move(doubt));
  }
  AddDoubtsOfKinds(reports, names, &doubts);
  for (std::size_t j = 1; j < reports.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const int shared = SharedFrames(reports[i]->plan.input.recording.markers,
                                      reports[j]->plan.input.recording.markers);
      if (shared < kFewestShared) continue;
      doubts.push_back(fmt::format("{} and {} have {} frames in common: strides count twice",
                                   names[i], names[j], shared));
    }
  }
  return doubts;
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
