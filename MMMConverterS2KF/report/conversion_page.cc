// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/conversion_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "MMMConverterS2KF/report/ground_json.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/report/report.h"
#include "common/pipeline/all_motions.h"
#include "common/pipeline/conversion.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// By whom it is known best: the user, the calibrated person, the recording.
std::string NameOf(const ConversionPlan& plan) {
  const Recording& recording = plan.input.recording;
  if (!plan.patient.name.empty()) return plan.patient.name;
  if (plan.person.subject && !plan.person.subject->name.empty()) return plan.person.subject->name;
  return recording.origin.subject.empty() ? recording.subject : recording.origin.subject;
}

Json ValueJson(const PersonValue& value, double deviation) {
  return {{"value", value.value > 0 ? Number(value.value) : Json(nullptr)},
          {"source", value.source},
          {"deviation", deviation > 0 ? Number(deviation) : Json(nullptr)}};
}

Json RecordingJson(const ConversionReport& report) {
  const Recording& recording = report.plan.input.recording;
  return {{"file", std::filesystem::path(recording.file).filename().string()},
          {"motion", TextOrNull(recording.motion())},
          {"date", TextOrNull(recording.origin.date)},
          {"condition", TextOrNull(report.plan.patient.condition)},
          {"system", TextOrNull(recording.origin.system)},
          {"frames", recording.markers.num_frames()},
          {"rate_hz", Number(recording.markers.rate())},
          {"verdict", Name(report.verdict.level)},
          {"reasons", report.verdict.reasons}};
}

/// Who was recorded, when, how and by what: the head of the page that a clinician prints. Null: the
/// recordings are of an object.
Json PatientJson(const std::vector<const ConversionReport*>& reports) {
  const auto is_of_object = [](const auto* one) { return one->plan.object.has_value(); };
  if (std::any_of(reports.begin(), reports.end(), is_of_object)) return nullptr;
  const ConversionPlan& plan = reports.front()->plan;
  Json recordings = Json::array();
  for (const ConversionReport* one : reports) recordings.push_back(RecordingJson(*one));
  return {{"name", TextOrNull(NameOf(plan))},
          {"height_m", ValueJson(plan.person.height, plan.person.height_deviation)},
          {"mass_kg", ValueJson(plan.person.mass, 0)},
          {"recordings", recordings}};
}

// The verdict and, where there was one, the calibration.
std::string DescribeForPage(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  std::string text = fmt::format("Verdict: {}.", DescribeVerdict(report.verdict));
  if (!plan.calibration) return text;
  return text + fmt::format(
                    "\n\nThe person \"{}\" was calibrated on {} frames of this recording: the best "
                    "postures leave "
                    "{:.1f} mm to the markers where the model scaled by height, with each marker "
                    "where it is usually worn, leaves {:.1f}.",
                    plan.person.subject->name, plan.calibration->frames,
                    kMillimetres * plan.calibration->distance_after,
                    kMillimetres * plan.calibration->distance_before);
}

Comparison MakeComparison(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  Trial trial;
  trial.name = std::filesystem::path(plan.input.recording.file).filename().string();
  trial.markers = plan.input.recording.markers;
  trial.model = plan.setup.model;
  trial.subject = plan.person.subject;
  Contender contender;
  contender.name = std::filesystem::path(plan.converter.config.file).stem().string();
  contender.configuration = plan.converter.text;
  contender.config = plan.converter.config;
  return CompareFinished(std::move(trial), {contender},
                         {{plan.setup.mapping, report.warnings, report.result}});
}

// The motion; of several those of a file, or the person of several files.
std::string TitleOf(const std::vector<const ConversionReport*>& reports, std::size_t failed) {
  const ConversionPlan& first = reports.front()->plan;
  if (reports.size() + failed == 1) return first.motion_name;
  const bool is_one_file = std::all_of(reports.begin(), reports.end(), [&](const auto* one) {
    return one->plan.input.recording.file == first.input.recording.file;
  });
  if (is_one_file && failed == 0)
    return std::filesystem::path(first.input.recording.file).filename().string();
  const std::string count =
      failed == 0 ? fmt::format("{} recordings", reports.size())
                  : fmt::format("{} of {} recordings", reports.size(), reports.size() + failed);
  return first.person.subject ? fmt::format("{}: {}", first.person.subject->name, count) : count;
}

}  // namespace

std::string FormatConversionPage(const std::vector<const ConversionReport*>& reports,
                                 const std::vector<std::string>& failures) {
  std::string of_all;
  for (const std::string& failure : failures) of_all += "\n\nNot converted: " + failure;
  for (const std::string& doubt : DoubtsTogether(reports)) of_all += "\n\n" + doubt + ".";
  const std::vector<std::string> names = NamesOfReports(reports);
  std::vector<Comparison> comparisons;
  std::vector<Json> grounds;
  std::vector<ReportSection> sections;
  comparisons.reserve(reports.size());
  grounds.reserve(reports.size());
  sections.reserve(reports.size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const ConversionReport* report = reports[i];
    comparisons.push_back(MakeComparison(*report));
    grounds.push_back(GroundJson(*report));
    const auto namesakes = std::count_if(reports.begin(), reports.end(), [&](const auto* one) {
      return one->plan.motion_name == report->plan.motion_name;
    });
    sections.push_back({namesakes > 1 ? names[i] : report->plan.motion_name,
                        DescribeForPage(*report) + of_all, &comparisons.back(), &grounds.back(),
                        Name(report->verdict.level)});
  }
  const Json patient = PatientJson(reports);
  return FormatReport(TitleOf(reports, failures.size()), sections, &patient);
}

}  // namespace mmm_converter
