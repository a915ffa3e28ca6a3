// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/conversion_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "MMMConverterS2KF/report/ground_json.h"
#include "MMMConverterS2KF/report/patient_json.h"
#include "MMMConverterS2KF/report/report.h"
#include "common/pipeline/all_motions.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

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
