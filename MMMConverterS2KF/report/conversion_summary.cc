// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/conversion_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/label_summary.h"
#include "MMMConverterS2KF/report/names_summary.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/pipeline/motion_output.h"
#include "common/study/conversion_figures.h"
#include "common/study/coverage.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Label and mean distance [mm] of the three that are farthest off.
std::string WorstMarkers(const ConversionReport& report, const ConversionFigures& figures) {
  std::vector<std::pair<double, std::string>> means;
  for (std::size_t i = 0; i < figures.of_markers.size(); ++i) {
    const double mean = kMillimetres * figures.of_markers[i].mean;
    if (!std::isnan(mean)) means.emplace_back(mean, LabelOf(report.plan, static_cast<int>(i)));
  }
  std::sort(means.rbegin(), means.rend());
  means.resize(std::min<std::size_t>(means.size(), 3));
  std::vector<std::string> texts;
  texts.reserve(means.size());
  for (const auto& [mean, label] : means) texts.push_back(fmt::format("{} {:.1f}", label, mean));
  return JoinNames(texts, ", ");
}

// A line for each incident, the longest first.
std::string DescribeWrongMarkers(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  constexpr std::size_t kMostLines = 8;
  std::vector<MarkerIncident> incidents = report.result.incidents;
  const auto length = [](const MarkerIncident& i) { return i.last_frame - i.first_frame; };
  std::stable_sort(
      incidents.begin(), incidents.end(),
      [&](const MarkerIncident& a, const MarkerIncident& b) { return length(a) > length(b); });
  std::string text;
  const MarkerSequence& markers = plan.input.recording.markers;
  for (std::size_t i = 0; i < std::min(incidents.size(), kMostLines); ++i) {
    const MarkerIncident& incident = incidents[i];
    std::string names = LabelOf(plan, incident.assignment);
    if (incident.other >= 0) names += " and " + LabelOf(plan, incident.other);
    text += fmt::format("{}  {} {}, frames {} to {} ({:.2f} to {:.2f} s)\n",
                        i == 0 ? "wrong    " : "         ", names, Name(incident.kind),
                        plan.input.first_frame + incident.first_frame,
                        plan.input.first_frame + incident.last_frame,
                        markers.time(incident.first_frame), markers.time(incident.last_frame));
  }
  if (incidents.size() > kMostLines) {
    text += fmt::format("           and {} shorter ones (all in --summary)\n",
                        incidents.size() - kMostLines);
  }
  if (!incidents.empty())
    text += "           label --repair tells which of these are wrong labels, and corrects them\n";
  return text;
}

std::string DescribePersonShortly(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  if (plan.person.height.value <= 0) return plan.person.height.source;
  return fmt::format("{}, {:.4g} kg ({})", DescribeHeight(plan.person), plan.person.mass.value,
                     plan.person.mass.source);
}

std::string DescribeMarkersShortly(const MarkerMapping& mapping) {
  std::string text = fmt::format("{} used", mapping.assignments.size());
  if (!mapping.absent_markers.empty()) {
    text += fmt::format(", {} not in the recording ({})", mapping.absent_markers.size(),
                        FirstNames(mapping.absent_markers));
  }
  if (!mapping.ignored_labels.empty()) {
    text += fmt::format(", {} labels ignored", mapping.ignored_labels.size());
  }
  return text;
}

std::string DescribeSubject(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  if (!plan.person.subject) return "";
  const Subject& subject = *plan.person.subject;
  if (plan.input.model->subject) {
    return fmt::format("calibrated \"{}\": {} markers\n", subject.name, subject.offsets.size());
  }
  std::string text = fmt::format("subject    \"{}\": {} segments, {} markers", subject.name,
                                 subject.scales.size(), subject.offsets.size());
  if (!plan.calibration) {
    const std::string& file = plan.person.subject_file;
    return text + ", from " + (file.empty() ? "the skeleton" : file) + "\n";
  }
  return text +
         fmt::format(
             ", from this recording: best postures of {} frames {:.1f} mm from the markers, "
             "{:.1f} with each where it is usually worn\n",
             plan.calibration->frames, kMillimetres * plan.calibration->distance_after,
             kMillimetres * plan.calibration->distance_before) +
         FormatSubjectSummary(subject);
}

// What an MMM program does with the motion.
std::string DescribeSubjectOutput(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  if (!plan.person.subject || plan.input.model->subject) return "";
  std::string text =
      "note       the angles are the subject's; on the model scaled by height and mass, which the "
      "motion\n           names, segments and markers differ";
  if (plan.model_output.empty()) return text + "; --model-out writes the subject's model\n";
  return text + ". The subject's model: " + plan.model_output + "\n";
}

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

std::string FormatSummary(const ConversionReport& report) {
  const ConversionPlan& plan = report.plan;
  const Recording& recording = plan.input.recording;
  const MarkerSequence& markers = recording.markers;
  const ConversionFigures& figures = report.figures;
  std::string text;
  text += fmt::format("recording  {}: {}, {} frames at {:.6g} Hz, {}{}, up is {}\n", recording.file,
                      recording.format, markers.num_frames(), markers.rate(), recording.unit,
                      recording.unit_was_guessed ? " (guessed)" : "", Name(recording.up_axis));
  if (plan.labels) text += fmt::format("labels     {}\n", DescribeLabels(*plan.labels));
  text += plan.object ? fmt::format("object     rigid, {}\n", DescribeObjectModel(*plan.object))
                      : fmt::format("person     {}\n", DescribePersonShortly(report));
  text += DescribeSubject(report);
  text += fmt::format("model      {}, {} joints tracked\n", plan.input.model_file,
                      report.result.trajectory.joint_names.size());
  text +=
      fmt::format("converter  {}, {}\n", plan.converter.config.type, plan.converter.config.file);
  text += fmt::format("markers    {}{}\n", DescribeMarkersShortly(plan.setup.mapping),
                      plan.setup.marker_set.empty() ? "" : ", marker set " + plan.setup.marker_set);
  const std::string unshown = DescribeUnshown(plan.setup);
  if (!plan.object && !unshown.empty()) {
    text += "not shown  " + unshown + ": at rest, with large deviations\n";
  }
  if (plan.input.names) text += "names      " + DescribeNames(*plan.input.names);
  text += fmt::format("distance   mean {:.1f} mm, p95 {:.1f}, max {:.1f}; largest means: {}\n",
                      kMillimetres * figures.distance.mean, kMillimetres * figures.distance.p95,
                      kMillimetres * figures.distance.max, WorstMarkers(report, figures));
  text += fmt::format("frames     {} with missing markers, {} not converged, {} reinitialised\n",
                      figures.frames_with_missing_markers, figures.frames_not_converged,
                      figures.frames_reassembled);
  if (const auto scale = report.result.process_noise_scale) {
    text +=
        fmt::format("noise      process noise times {:.3g}, chosen from the recording\n", *scale);
  }
  text += DescribeWrongMarkers(report);
  text += fmt::format("time       median {:.3f} ms a frame, p99 {:.3f}\n", figures.median_ms,
                      figures.p99_ms);
  text += fmt::format("motion     {} ({}, \"{}\")\n", plan.output, MotionFormat(plan),
                      plan.motion_name);
  const bool has_deviations = !report.result.trajectory.standard_deviations.array().isNaN().all();
  const std::string deviations = DeviationsOutput(plan);
  if (has_deviations && !deviations.empty()) text += "deviations " + deviations + "\n";
  text += DescribeSubjectOutput(report);
  return text + FormatVerdict(report.verdict);
}

std::string FormatVerdict(const Verdict& verdict) {
  std::string text = fmt::format("verdict    {}\n", Name(verdict.level));
  for (const std::string& reason : verdict.reasons) text += "           " + reason + "\n";
  return text;
}

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
