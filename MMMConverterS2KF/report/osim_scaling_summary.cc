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

struct BodyFactors {
  std::string name;
  Eigen::Vector3d factors, deviations;
};

/// Of the bodies whose size was estimated; others go with one of them.
std::vector<BodyFactors> FactorsOf(const OsimScalingReport& report, const Subject& subject) {
  std::vector<BodyFactors> bodies;
  for (std::size_t i = 0; i + 2 < subject.scales.size(); i += 3) {
    BodyFactors& body = bodies.emplace_back();
    const std::string& name = subject.scales[i].segment;
    body.name = name.substr(0, name.rfind(' '));
    for (int axis = 0; axis < 3; ++axis) {
      const SegmentScale& scale = subject.scales[i + static_cast<std::size_t>(axis)];
      body.factors[axis] = report.size * scale.scale;
      body.deviations[axis] = report.size * scale.standard_deviation;
    }
  }
  return bodies;
}

std::string FormatOsimCalibration(const OsimScalingReport& report, const CalibrationResult& result,
                                  const std::string& file) {
  std::string text = FormatTakenFrames(report.recordings, result.subject);
  text += fmt::format("{:24} {}\n", "along", "x               y               z");
  for (const BodyFactors& body : FactorsOf(report, result.subject)) {
    text += fmt::format("{:24}", body.name);
    for (int axis = 0; axis < 3; ++axis) {
      text += fmt::format(" {:.3f} +- {:.3f} ", body.factors[axis], body.deviations[axis]);
    }
    text.back() = '\n';
  }
  text += fmt::format("{:24} {:.3f} kg\n", "mass", report.scaled.mass);
  text += fmt::format(
      "{:24} {} moved; the best postures leave {:.1f} mm to them, {:.1f} at the places of "
      "the model\n",
      "markers", report.scaled.placed_markers, kMillimetres * result.distance_after,
      kMillimetres * result.distance_before);
  return text + fmt::format("Calibrated on {} frames: wrote {}\n", result.frames, file) +
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
    for (const BodyFactors& body : FactorsOf(report, report.result->subject)) {
      const Eigen::Vector3d& deviations = body.deviations;
      summary["factor_deviations"][body.name] = {deviations.x(), deviations.y(), deviations.z()};
    }
    summary["verdict"] = ToJson(*report.verdict);
  }
  return summary;
}

}  // namespace mmm_converter
