// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/all_motions_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "common/motion/marker_residuals.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

std::string DescribeModel(const ConversionReport& report) {
  if (!report.plan.object) {
    return fmt::format("{} joints", report.result.trajectory.joint_names.size());
  }
  const std::string file =
      report.plan.object->is_built() ? ": " + report.plan.input.model_file : "";
  return "object, " + DescribeObjectModel(*report.plan.object) + file;
}

std::string DescribeOutcome(const MotionOutcome& outcome) {
  if (!outcome.failure.empty()) return "not converted";
  if (!outcome.report) return "has no markers; left as it is";
  const ConversionReport& report = *outcome.report;
  const ResidualSummary& distance = report.figures.distance;
  return fmt::format("{} frames, {} markers, mean distance {:.1f} mm, max {:.1f}; {}; {}",
                     report.plan.input.recording.markers.num_frames(),
                     report.plan.setup.assignments().size(), kMillimetres * distance.mean,
                     kMillimetres * distance.max, DescribeModel(report),
                     DescribeVerdict(report.verdict));
}

}  // namespace

std::string FormatAllMotions(const AllMotions& all) {
  std::size_t width = 0;
  for (const MotionOutcome& outcome : all.motions) width = std::max(width, outcome.name.size());
  std::string text;
  for (const MotionOutcome& outcome : all.motions) {
    text += fmt::format("{:<{}}  {}\n", outcome.name, width, DescribeOutcome(outcome));
  }
  return text + fmt::format("written to {}\n", all.output);
}

Json ToJson(const AllMotions& all) {
  Json motions = Json::array();
  for (const MotionOutcome& outcome : all.motions) {
    motions.push_back({{"name", outcome.name},
                       {"failure", TextOrNull(outcome.failure)},
                       {"summary", outcome.report ? ToJson(*outcome.report) : Json(nullptr)}});
  }
  return {{"output", all.output}, {"motions", motions}};
}

}  // namespace mmm_converter
