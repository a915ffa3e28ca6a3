// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/conversion_page.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "MMMConverterS2KF/report/report.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// The verdict and, where there was one, the calibration.
std::string DescribeForPage(const ConversionReport& report) {
  std::string text = fmt::format("Verdict: {}.", DescribeVerdict(report.verdict));
  if (!report.calibration) return text;
  return text + fmt::format(
                    "\n\nThe person \"{}\" was calibrated on {} frames of this recording: the best "
                    "postures leave "
                    "{:.1f} mm to the markers where the model scaled by height leaves {:.1f}.",
                    report.person.subject->name, report.calibration->frames,
                    kMillimetres * report.calibration->distance_after,
                    kMillimetres * report.calibration->distance_before);
}

Comparison MakeComparison(const ConversionReport& report) {
  Trial trial;
  trial.name = std::filesystem::path(report.input.recording.file).filename().string();
  trial.markers = report.input.recording.markers;
  trial.model = report.setup.model;
  trial.subject = report.person.subject;
  Contender contender;
  contender.name = std::filesystem::path(report.converter.config.file).stem().string();
  contender.configuration = report.converter.text;
  contender.config = report.converter.config;
  return CompareFinished(std::move(trial), {contender},
                         {{report.setup.mapping, report.warnings, report.result}});
}

}  // namespace

std::string FormatConversionPage(const std::vector<const ConversionReport*>& reports) {
  std::vector<Comparison> comparisons;
  std::vector<ReportSection> sections;
  comparisons.reserve(reports.size());
  sections.reserve(reports.size());
  for (const ConversionReport* report : reports) {
    comparisons.push_back(MakeComparison(*report));
    sections.push_back({report->motion_name, DescribeForPage(*report), &comparisons.back()});
  }
  const std::string title =
      reports.size() == 1
          ? reports.front()->motion_name
          : std::filesystem::path(reports.front()->input.recording.file).filename().string();
  return FormatReport(title, sections);
}

}  // namespace mmm_converter
