// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/label_summary.h"
#include "MMMConverterS2KF/report/names_summary.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/pipeline/motion_output.h"
#include "common/study/conversion_figures.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

Json ToJson(const ResidualSummary& distance) {
  return {{"mean", Number(kMillimetres * distance.mean)},
          {"p95", Number(kMillimetres * distance.p95)},
          {"max", Number(kMillimetres * distance.max)}};
}

Json DescribeInput(const ConversionReport& report) {
  const Recording& recording = report.plan.input.recording;
  return {{"file", recording.file},
          {"format", recording.format},
          {"subject", recording.subject},
          {"motion", recording.motion()},
          {"unit", recording.unit},
          {"unit_guessed", recording.unit_was_guessed},
          {"up_axis", Name(recording.up_axis)},
          {"up_axis_stated",
           recording.stated_up_axis ? Json(Name(*recording.stated_up_axis)) : Json(nullptr)},
          {"up_axis_decided_from_markers", recording.up_axis_was_decided},
          {"first_frame", report.plan.input.first_frame},
          {"labels", recording.markers.labels()}};
}

Json DescribePerson(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  if (plan.object) return nullptr;
  Json person = {
      {"height_m", Number(plan.person.height.value)},
      {"height_source", plan.person.height.source},
      {"height_deviation_m",
       plan.person.height_deviation > 0 ? Number(plan.person.height_deviation) : Json(nullptr)},
      {"mass_kg", Number(plan.person.mass.value)},
      {"mass_source", plan.person.mass.source}};
  if (plan.person.hand_length) person["hand_length_m"] = Number(*plan.person.hand_length);
  return person;
}

Json DescribeMarkers(const ConversionReport& report, const ConversionFigures& figures) {
  const ConversionPlan& plan = report.plan;
  Json used = Json::array();
  for (std::size_t i = 0; i < plan.setup.assignments().size(); ++i) {
    const MarkerAssignment& assignment = plan.setup.assignments()[i];
    used.push_back({{"label", LabelOf(plan, static_cast<int>(i))},
                    {"marker", plan.setup.model->markers()[assignment.marker].name},
                    {"noise_scale", assignment.noise_scale},
                    {"frames_seen", figures.of_markers[i].seen},
                    {"distance_mm", ToJson(figures.of_markers[i])}});
  }
  return {{"set", plan.setup.marker_set},
          {"used", used},
          {"ignored", plan.setup.mapping.ignored_labels},
          {"absent", plan.setup.mapping.absent_markers},
          {"names", plan.input.names ? NamesJson(*plan.input.names) : Json(nullptr)}};
}

Json WrongMarkersJson(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  Json incidents = Json::array();
  const MarkerSequence& markers = plan.input.recording.markers;
  for (const MarkerIncident& incident : report.result.incidents) {
    Json labels = {LabelOf(plan, incident.assignment)};
    if (incident.other >= 0) labels.push_back(LabelOf(plan, incident.other));
    incidents.push_back({{"kind", Name(incident.kind)},
                         {"labels", labels},
                         {"first_frame", plan.input.first_frame + incident.first_frame},
                         {"last_frame", plan.input.first_frame + incident.last_frame},
                         {"first_s", Number(markers.time(incident.first_frame))},
                         {"last_s", Number(markers.time(incident.last_frame))}});
  }
  return incidents;
}

Json ObjectJson(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  if (!plan.object) return nullptr;
  return {{"model_source", plan.object->source},
          {"model_is_new", plan.object->is_built()},
          {"shape_distance_mm",
           plan.object->is_built() ? Number(kMillimetres * plan.object->distance) : Json(nullptr)}};
}

Json SubjectJson(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  if (!plan.person.subject) return nullptr;
  Json json = {{"file", plan.person.subject_file},
               {"subject_output", plan.subject_output},
               {"model_output", plan.model_output},
               {"calibration", nullptr}};
  if (plan.calibration) {
    json["calibration"] = ToJson(*plan.calibration);
  }
  json.update(ToJson(*plan.person.subject));
  return json;
}

}  // namespace

Json ToJson(const Verdict& verdict) {
  return {{"level", Name(verdict.level)}, {"reasons", verdict.reasons}};
}

Json ToJson(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  const MarkerSequence& markers = plan.input.recording.markers;
  const ConversionFigures& figures = report.figures;
  return {
      {"verdict", ToJson(report.verdict)},
      {"input", DescribeInput(report)},
      {"frames", markers.num_frames()},
      {"rate_hz", markers.rate()},
      {"output", plan.output},
      {"output_format", IsOsimMotion(plan) ? "OpenSim" : plan.output_format},
      {"motion", plan.motion_name},
      {"model", plan.input.model_file},
      {"person", DescribePerson(report)},
      {"object", ObjectJson(report)},
      {"subject", SubjectJson(report)},
      {"labels",
       plan.labels ? LabelsJson(*plan.labels, markers, plan.input.first_frame) : Json(nullptr)},
      {"converter", plan.converter.config.type},
      {"plugin", plan.converter.plugin->path()},
      {"configuration", plan.converter.config.file},
      {"joints", report.result.trajectory.joint_names},
      {"markers", DescribeMarkers(report, figures)},
      {"distance_mm", ToJson(figures.distance)},
      {"frames_with_missing_markers", figures.frames_with_missing_markers},
      {"frames_not_converged", figures.frames_not_converged},
      {"frames_reassembled", figures.frames_reassembled},
      {"process_noise_scale", report.result.process_noise_scale
                                  ? Number(*report.result.process_noise_scale)
                                  : Json(nullptr)},
      {"nis_over_degrees_of_freedom", Number(figures.nis)},
      {"wrong_markers", WrongMarkersJson(report)},
      {"ms_per_frame", {{"median", Number(figures.median_ms)}, {"p99", Number(figures.p99_ms)}}},
      {"warnings", report.warnings.texts()}};
}

}  // namespace mmm_converter
