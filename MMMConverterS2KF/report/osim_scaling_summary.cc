// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/osim_scaling_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/support/units.h"

namespace mmm_converter {

namespace {

std::string FormatOsimCalibration(const OsimScalingReport& report, const CalibrationResult& result,
                                  const std::string& file) {
  std::string text;
  for (const SegmentScale& scale : result.subject.scales) {
    text += fmt::format("{:24} {:.3f} +- {:.3f}\n", scale.segment, report.size * scale.scale,
                        report.size * scale.standard_deviation);
  }
  text += fmt::format("{:24} {:.3f} kg\n", "mass", report.scaled.mass);
  text += fmt::format(
      "{:24} {} moved; the best postures leave {:.1f} mm to them, {:.1f} at the places of "
      "the model\n",
      "markers", report.scaled.placed_markers, kMillimetres * result.distance_after,
      kMillimetres * result.distance_before);
  return text +
         fmt::format("Calibrated on {} frames of {} recordings: wrote {}\n", result.frames,
                     result.subject.sources.size(), file) +
         FormatVerdict(*report.verdict);
}

}  // namespace

std::string FormatOsimScalingSummary(const OsimScalingReport& report, const std::string& file) {
  const ScaledOsim& scaled = report.scaled;
  if (report.result) return FormatOsimCalibration(report, *report.result, file);
  std::string text;
  for (const auto& [body, factor] : scaled.factors) {
    text += factor.isConstant(factor[0]) ? fmt::format("{:24} {:.4f}\n", body, factor[0])
                                         : fmt::format("{:24} {:.4f} {:.4f} {:.4f}\n", body,
                                                       factor[0], factor[1], factor[2]);
  }
  text += fmt::format("{:24} {:.3f} kg\n", "mass", scaled.mass);
  if (scaled.placed_markers > 0) {
    text += fmt::format(
        "{:24} {} moved onto the recording's; before, those with tasks were "
        "{:.1f} mm from them (rms)\n",
        "markers", scaled.placed_markers, kMillimetres * scaled.distance);
  }
  return text + fmt::format("Scaled {} bodies by {} frames: wrote {}\n", scaled.factors.size(),
                            report.frames, file);
}

Json ToJson(const OsimScalingReport& report, const std::string& file) {
  const ScaledOsim& scaled = report.scaled;
  Json bodies = Json::object();
  for (const auto& [body, factor] : scaled.factors) {
    bodies[body] = {factor.x(), factor.y(), factor.z()};
  }
  Json summary = {{"program", SubjectProgram()},
                  {"output", file},
                  {"frames", report.frames},
                  {"mass_kg", scaled.mass},
                  {"placed_markers", scaled.placed_markers},
                  {"factors", bodies},
                  {"warnings", report.warnings.texts()}};
  if (report.result) {
    summary["calibration"] = ToJson(*report.result);
    summary["size"] = report.size;
    summary["subject"] = ToJson(report.result->subject);
    summary["verdict"] = ToJson(*report.verdict);
  }
  return summary;
}

}  // namespace mmm_converter
