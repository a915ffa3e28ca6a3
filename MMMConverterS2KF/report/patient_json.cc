// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/patient_json.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace

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

}  // namespace mmm_converter
