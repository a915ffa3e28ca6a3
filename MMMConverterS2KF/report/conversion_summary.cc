// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/conversion_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/subject_json.h"
#include "common/math/statistics.h"
#include "common/motion/marker_residuals.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1000;  // in a metre
constexpr double kMilliseconds = 1000;

std::vector<double> FrameTimes(const ConversionReport& report) {
  std::vector<double> times;
  for (const FrameDiagnostic& frame : report.result.frames) {
    if (frame.seconds > 0) times.push_back(kMilliseconds * frame.seconds);
  }
  return times;
}

template <typename Predicate>
int CountFrames(const ConversionReport& report, Predicate is_counted) {
  return static_cast<int>(
      std::count_if(report.result.frames.begin(), report.result.frames.end(), is_counted));
}

int FramesNotConverged(const ConversionReport& report) {
  return CountFrames(report, [](const FrameDiagnostic& f) { return !f.converged; });
}

/// The mean over the frames in which the converter states one; NaN where it never does.
double MeanNis(const ConversionReport& report) {
  std::vector<double> values;
  for (const FrameDiagnostic& frame : report.result.frames) {
    if (frame.nis > 0) values.push_back(frame.nis);
  }
  return Mean(values);
}

int FramesReassembled(const ConversionReport& report) {
  return CountFrames(report, [](const FrameDiagnostic& f) { return f.reassembled; });
}

// Four decimals; JSON has no NaN.
Json Number(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e4) / 1e4) : Json(nullptr);
}

Json ToJson(const ResidualSummary& distance) {
  return {{"mean", Number(kMillimetres * distance.mean)},
          {"p95", Number(kMillimetres * distance.p95)},
          {"max", Number(kMillimetres * distance.max)}};
}

Json DescribeInput(const ConversionReport& report) {
  const Recording& recording = report.input.recording;
  return {{"file", recording.file},
          {"format", recording.format},
          {"subject", recording.subject},
          {"motion", recording.motion},
          {"unit", recording.unit},
          {"unit_guessed", recording.unit_was_guessed},
          {"up_axis", Name(recording.up_axis)},
          {"up_axis_decided_from_markers", recording.up_axis_was_decided},
          {"first_frame", report.input.first_frame},
          {"labels", recording.markers.labels()}};
}

Json DescribePerson(const ConversionReport& report) {
  if (report.object) return nullptr;
  Json person = {{"height_m", Number(report.person.height.value)},
                 {"height_source", report.person.height.source},
                 {"mass_kg", Number(report.person.mass.value)},
                 {"mass_source", report.person.mass.source}};
  if (report.person.hand_length) person["hand_length_m"] = Number(*report.person.hand_length);
  return person;
}

Json DescribeMarkers(const ConversionReport& report) {
  Json used = Json::array();
  const std::vector<ResidualSummary> distances = SummarizeEachMarker(report.result.residuals);
  for (std::size_t i = 0; i < report.setup.assignments().size(); ++i) {
    const MarkerAssignment& assignment = report.setup.assignments()[i];
    used.push_back({{"label", report.input.recording.markers.labels()[assignment.label]},
                    {"marker", report.setup.model->markers()[assignment.marker].name},
                    {"noise_scale", assignment.noise_scale},
                    {"frames_seen", distances[i].seen},
                    {"distance_mm", ToJson(distances[i])}});
  }
  return {{"set", report.setup.marker_set},
          {"used", used},
          {"ignored", report.setup.mapping.ignored_labels},
          {"absent", report.setup.mapping.absent_markers}};
}

std::string WorstMarkers(const ConversionReport& report) {
  std::vector<std::pair<double, std::string>> means;
  const std::vector<ResidualSummary> distances = SummarizeEachMarker(report.result.residuals);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double mean = kMillimetres * distances[i].mean;
    const int label = report.setup.assignments()[i].label;
    if (!std::isnan(mean)) means.emplace_back(mean, report.input.recording.markers.labels()[label]);
  }
  std::sort(means.rbegin(), means.rend());
  means.resize(std::min<std::size_t>(means.size(), 3));
  std::vector<std::string> texts;
  texts.reserve(means.size());
  for (const auto& [mean, label] : means) texts.push_back(fmt::format("{} {:.1f}", label, mean));
  return JoinNames(texts, ", ");
}

// Label of an assignment.
const std::string& LabelOf(const ConversionReport& report, int assignment) {
  const int label = report.setup.assignments()[assignment].label;
  return report.input.recording.markers.labels()[label];
}

Json WrongMarkersJson(const ConversionReport& report) {
  Json incidents = Json::array();
  const MarkerSequence& markers = report.input.recording.markers;
  for (const MarkerIncident& incident : report.result.incidents) {
    Json labels = {LabelOf(report, incident.assignment)};
    if (incident.other >= 0) labels.push_back(LabelOf(report, incident.other));
    incidents.push_back({{"kind", Name(incident.kind)},
                         {"labels", labels},
                         {"first_frame", report.input.first_frame + incident.first_frame},
                         {"last_frame", report.input.first_frame + incident.last_frame},
                         {"first_s", Number(markers.time(incident.first_frame))},
                         {"last_s", Number(markers.time(incident.last_frame))}});
  }
  return incidents;
}

// A line for each incident, the longest first.
std::string DescribeWrongMarkers(const ConversionReport& report) {
  constexpr std::size_t kMostLines = 8;
  std::vector<MarkerIncident> incidents = report.result.incidents;
  const auto length = [](const MarkerIncident& i) { return i.last_frame - i.first_frame; };
  std::stable_sort(
      incidents.begin(), incidents.end(),
      [&](const MarkerIncident& a, const MarkerIncident& b) { return length(a) > length(b); });
  std::string text;
  const MarkerSequence& markers = report.input.recording.markers;
  for (std::size_t i = 0; i < std::min(incidents.size(), kMostLines); ++i) {
    const MarkerIncident& incident = incidents[i];
    std::string names = LabelOf(report, incident.assignment);
    if (incident.other >= 0) names += " and " + LabelOf(report, incident.other);
    text += fmt::format("{}  {} {}, frames {} to {} ({:.2f} to {:.2f} s)\n",
                        i == 0 ? "wrong    " : "         ", names, Name(incident.kind),
                        report.input.first_frame + incident.first_frame,
                        report.input.first_frame + incident.last_frame,
                        markers.time(incident.first_frame), markers.time(incident.last_frame));
  }
  if (incidents.size() > kMostLines) {
    text += fmt::format("           and {} shorter ones (all in --summary)\n",
                        incidents.size() - kMostLines);
  }
  return text;
}

std::string DescribePersonShortly(const ConversionReport& report) {
  if (report.person.height.value <= 0) return report.person.height.source;
  return fmt::format("{:.3g} m ({}), {:.4g} kg ({})", report.person.height.value,
                     report.person.height.source, report.person.mass.value,
                     report.person.mass.source);
}

std::string DescribeMarkersShortly(const MarkerMapping& mapping) {
  std::string text = fmt::format("{} used", mapping.assignments.size());
  if (!mapping.absent_markers.empty()) {
    text += fmt::format(", {} not in the recording ({})", mapping.absent_markers.size(),
                        JoinNames(mapping.absent_markers, ", "));
  }
  if (!mapping.ignored_labels.empty()) {
    text += fmt::format(", {} labels ignored", mapping.ignored_labels.size());
  }
  return text;
}

std::string DescribeSubject(const ConversionReport& report) {
  if (!report.person.subject) return "";
  const Subject& subject = *report.person.subject;
  std::string text = fmt::format("subject    \"{}\": {} segments, {} markers", subject.name,
                                 subject.scales.size(), subject.offsets.size());
  if (!report.calibration) return text + ", from " + report.person.subject_file + "\n";
  return text +
         fmt::format(
             ", from this recording: best postures of {} frames {:.1f} mm from the markers, "
             "{:.1f} without\n",
             report.calibration->frames, kMillimetres * report.calibration->distance_after,
             kMillimetres * report.calibration->distance_before) +
         FormatSubjectSummary(subject);
}

// What an MMM program does with the motion.
std::string DescribeSubjectOutput(const ConversionReport& report) {
  if (!report.person.subject) return "";
  std::string text =
      "played     the angles are the subject's; on the model scaled by height and mass, which the "
      "motion\n           names, segments and markers differ";
  if (report.model_output.empty()) return text + "; --model-out writes the subject's model\n";
  return text + ". The subject's model: " + report.model_output + "\n";
}

Json ObjectJson(const ConversionReport& report) {
  if (!report.object) return nullptr;
  return {
      {"model_source", report.object->source},
      {"model_is_new", report.object->is_built()},
      {"shape_distance_mm",
       report.object->is_built() ? Number(kMillimetres * report.object->distance) : Json(nullptr)}};
}

Json SubjectJson(const ConversionReport& report) {
  if (!report.person.subject) return nullptr;
  Json json = {{"file", report.person.subject_file},
               {"subject_output", report.subject_output},
               {"model_output", report.model_output},
               {"calibration", nullptr}};
  if (report.calibration) {
    json["calibration"] = Json::parse(FormatCalibrationFigures(*report.calibration));
  }
  json.update(Json::parse(FormatSubjectJson(*report.person.subject)));
  return json;
}

}  // namespace

std::string FormatSummary(const ConversionReport& report) {
  const Recording& recording = report.input.recording;
  const MarkerSequence& markers = recording.markers;
  const ResidualSummary distance = SummarizeResiduals(report.result.residuals);
  const std::vector<double> times = FrameTimes(report);
  std::string text;
  text += fmt::format("recording  {}: {}, {} frames at {:.6g} Hz, {}{}, up is {}\n", recording.file,
                      recording.format, markers.num_frames(), markers.rate(), recording.unit,
                      recording.unit_was_guessed ? " (guessed)" : "", Name(recording.up_axis));
  text += report.object ? fmt::format("object     rigid, {}\n", DescribeObjectModel(*report.object))
                        : fmt::format("person     {}\n", DescribePersonShortly(report));
  text += DescribeSubject(report);
  text += fmt::format("model      {}, {} joints tracked\n", report.input.model_file,
                      report.result.trajectory.joint_names.size());
  text += fmt::format("converter  {}, {}\n", report.converter.config.type,
                      report.converter.config.file);
  text +=
      fmt::format("markers    {}{}\n", DescribeMarkersShortly(report.setup.mapping),
                  report.setup.marker_set.empty() ? "" : ", marker set " + report.setup.marker_set);
  text += fmt::format("distance   mean {:.1f} mm, p95 {:.1f}, max {:.1f}; largest means: {}\n",
                      kMillimetres * distance.mean, kMillimetres * distance.p95,
                      kMillimetres * distance.max, WorstMarkers(report));
  text += fmt::format("frames     {} with missing markers, {} not converged, {} reinitialised\n",
                      FramesWithMissingMarkers(report.result.residuals), FramesNotConverged(report),
                      FramesReassembled(report));
  if (const auto scale = report.result.noise_scale) {
    text +=
        fmt::format("noise      process noise times {:.3g}, chosen from the recording\n", *scale);
  }
  text += DescribeWrongMarkers(report);
  text += fmt::format("time       median {:.3f} ms a frame, p99 {:.3f}\n", Median(times),
                      Percentile(times, 99));
  text += fmt::format("motion     {} (MMM {}, \"{}\")\n", report.output, report.output_format,
                      report.motion_name);
  text += DescribeSubjectOutput(report);
  return text;
}

std::string FormatSummaryJson(const ConversionReport& report) {
  const MarkerSequence& markers = report.input.recording.markers;
  const std::vector<double> times = FrameTimes(report);
  const Json summary = {
      {"input", DescribeInput(report)},
      {"frames", markers.num_frames()},
      {"rate_hz", markers.rate()},
      {"output", report.output},
      {"output_format", report.output_format},
      {"motion", report.motion_name},
      {"model", report.input.model_file},
      {"person", DescribePerson(report)},
      {"object", ObjectJson(report)},
      {"subject", SubjectJson(report)},
      {"converter", report.converter.config.type},
      {"plugin", report.converter.plugin->path()},
      {"configuration", report.converter.config.file},
      {"joints", report.result.trajectory.joint_names},
      {"markers", DescribeMarkers(report)},
      {"distance_mm", ToJson(SummarizeResiduals(report.result.residuals))},
      {"frames_with_missing_markers", FramesWithMissingMarkers(report.result.residuals)},
      {"frames_not_converged", FramesNotConverged(report)},
      {"frames_reassembled", FramesReassembled(report)},
      {"noise_scale",
       report.result.noise_scale ? Number(*report.result.noise_scale) : Json(nullptr)},
      {"nis_over_degrees_of_freedom", Number(MeanNis(report))},
      {"wrong_markers", WrongMarkersJson(report)},
      {"ms_per_frame", {{"median", Number(Median(times))}, {"p99", Number(Percentile(times, 99))}}},
      {"warnings", report.warnings}};
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mmm_converter
