// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/all_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "MMMConverterS2KF/conversion/motion_output.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/terminal/advice.h"
#include "common/motion/marker_residuals.h"
#include "common/support/error.h"
#include "common/support/output_plan.h"

namespace mmm_converter {
namespace {

using Json = nlohmann::ordered_json;

ConversionRequest RequestFor(const ConversionRequest& request, WithWarnings<Recording> recording) {
  ConversionRequest own = request;
  own.input.reading.motion = recording.value.motion;
  own.input.recording = {std::make_shared<const Recording>(std::move(recording.value)),
                         std::move(recording.warnings)};
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
  const Recording& recording = *request.input.recording.value;
  outcome.name = recording.motion;
  if (recording.markers.num_labels() == 0) return outcome;
  try {
    outcome.report = RunConversion(request, progress);
  } catch (const Error& error) {
    outcome.failure = WithAdvice(error);
  }
  return outcome;
}

// Names are what tells motions that are written apart.
void CheckNames(const std::vector<WithWarnings<Recording>>& recordings) {
  std::set<std::string> names;
  for (const auto& [recording, warnings] : recordings) {
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

std::string DescribeModel(const ConversionReport& report) {
  if (!report.object) {
    return fmt::format("{} joints", report.result.trajectory.joint_names.size());
  }
  const std::string file = report.object->is_built() ? ": " + report.input.model_file : "";
  return "object, " + DescribeObjectModel(*report.object) + file;
}

std::string DescribeOutcome(const MotionOutcome& outcome) {
  if (!outcome.failure.empty()) return "not converted";
  if (!outcome.report) return "has no markers; left as it is";
  const ConversionReport& report = *outcome.report;
  const ResidualSummary distance = SummarizeResiduals(report.result.residuals);
  return fmt::format("{} frames, {} markers, mean distance {:.1f} mm, max {:.1f}; {}",
                     report.input.recording.markers.num_frames(), report.mapping.assignments.size(),
                     1e3 * distance.mean, 1e3 * distance.max, DescribeModel(report));
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
  std::vector<WithWarnings<Recording>> recordings =
      ReadAllMotions(request.input.file, request.input.reading, &all.warnings);
  ConversionRequest of_each = request;
  of_each.choice = ChooseOnce(request.converter);
  CheckNames(recordings);
  of_each.input.model = ReadModelOnce(request.input);
  std::set<std::string> models;
  for (WithWarnings<Recording>& recording : recordings) {
    CheckFormat(request, *of_each.choice.value, recording.value);
    MotionOutcome outcome = ConvertOne(RequestFor(of_each, std::move(recording)), progress);
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

std::string FormatAllMotions(const AllMotions& all) {
  std::size_t width = 0;
  for (const MotionOutcome& outcome : all.motions) width = std::max(width, outcome.name.size());
  std::string text;
  for (const MotionOutcome& outcome : all.motions) {
    text += fmt::format("{:<{}}  {}\n", outcome.name, width, DescribeOutcome(outcome));
  }
  return text + fmt::format("written to {}\n", all.output);
}

std::string FormatAllMotionsJson(const AllMotions& all) {
  Json motions = Json::array();
  for (const MotionOutcome& outcome : all.motions) {
    motions.push_back({{"name", outcome.name},
                       {"failure", outcome.failure.empty() ? Json(nullptr) : Json(outcome.failure)},
                       {"summary", outcome.report ? Json::parse(FormatSummaryJson(*outcome.report))
                                                  : Json(nullptr)}});
  }
  const Json json = {{"output", all.output}, {"motions", motions}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mmm_converter
