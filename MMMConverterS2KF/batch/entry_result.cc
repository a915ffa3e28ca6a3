// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_result.h"

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "common/judge/conversion_figures.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kMillisecond = 3;  // decimals of seconds

void TakePerson(const ConversionReport& report, EntryFigures* figures) {
  const ConversionPlan& plan = report.plan;
  if (plan.object) return;
  figures->height = plan.person.height.value;
  figures->height_source = plan.person.height.source;
  figures->mass = plan.person.mass.value;
  figures->mass_source = plan.person.mass.source;
  if (plan.person.subject) figures->subject = plan.person.subject->name;
}

int ParseCount(const Json& json) {
  return static_cast<int>(ParseInteger(json, 0, std::numeric_limits<int>::max()));
}

double ParseNumber(const Json& json) { return json.is_null() ? kNaN : json.get<double>(); }

std::string ParseText(const Json& json) {
  return json.is_null() ? std::string() : json.get<std::string>();
}

Verdict ParseVerdict(const Json& json) {
  Verdict verdict;
  verdict.level = ParseVerdictLevel(json.at("level").get<std::string>());
  verdict.reasons = json.at("reasons").get<std::vector<std::string>>();
  return verdict;
}

EntryFigures ParseFigures(const Json& json) {
  EntryFigures figures;
  figures.verdict = ParseVerdict(json.at("verdict"));
  figures.frames = ParseCount(json.at("frames"));
  figures.rate = ParseNumber(json.at("rate_hz"));
  figures.height = ParseNumber(json.at("height_m"));
  figures.height_source = ParseText(json.at("height_source"));
  figures.mass = ParseNumber(json.at("mass_kg"));
  figures.mass_source = ParseText(json.at("mass_source"));
  if (!json.at("subject").is_null()) figures.subject = json.at("subject").get<std::string>();
  figures.converter = json.at("converter").get<std::string>();
  figures.configuration = json.at("configuration").get<std::string>();
  figures.markers_used = ParseCount(json.at("markers_used"));
  figures.markers_absent = ParseCount(json.at("markers_absent"));
  figures.markers_ignored = ParseCount(json.at("markers_ignored"));
  figures.mean_mm = ParseNumber(json.at("distance_mm").at("mean"));
  figures.p95_mm = ParseNumber(json.at("distance_mm").at("p95"));
  figures.max_mm = ParseNumber(json.at("distance_mm").at("max"));
  figures.worst_marker = ParseText(json.at("worst_marker"));
  figures.worst_marker_mm = ParseNumber(json.at("worst_marker_mm"));
  figures.frames_with_missing_markers = ParseCount(json.at("frames_with_missing_markers"));
  figures.frames_not_converged = ParseCount(json.at("frames_not_converged"));
  figures.frames_reassembled = ParseCount(json.at("frames_reassembled"));
  figures.wrong_markers = ParseCount(json.at("wrong_markers"));
  figures.process_noise_scale = ParseNumber(json.at("process_noise_scale"));
  figures.nis = ParseNumber(json.at("nis_over_degrees_of_freedom"));
  figures.median_ms = ParseNumber(json.at("ms_per_frame").at("median"));
  figures.p99_ms = ParseNumber(json.at("ms_per_frame").at("p99"));
  figures.warnings = json.at("warnings").get<std::vector<std::string>>();
  return figures;
}

}  // namespace

EntryResult Converted(const ConversionReport& report, double seconds) {
  const ConversionPlan& plan = report.plan;
  const ConversionFigures& measured = report.figures;
  EntryFigures figures;
  figures.verdict = report.verdict;
  figures.frames = plan.input.recording.markers.num_frames();
  figures.rate = plan.input.recording.markers.rate();
  TakePerson(report, &figures);
  figures.converter = plan.converter.config.type;
  figures.configuration = std::filesystem::path(plan.converter.config.file).stem().string();
  figures.markers_used = static_cast<int>(plan.setup.assignments().size());
  figures.markers_absent = static_cast<int>(plan.setup.mapping.absent_markers.size());
  figures.markers_ignored = static_cast<int>(plan.setup.mapping.ignored_labels.size());
  figures.mean_mm = kMillimetres * measured.distance.mean;
  figures.p95_mm = kMillimetres * measured.distance.p95;
  figures.max_mm = kMillimetres * measured.distance.max;
  if (const int worst = measured.worst_marker; worst >= 0) {
    figures.worst_marker = LabelOf(plan, worst);
    figures.worst_marker_mm =
        kMillimetres * measured.of_markers[static_cast<std::size_t>(worst)].mean;
  }
  figures.frames_with_missing_markers = measured.frames_with_missing_markers;
  figures.frames_not_converged = measured.frames_not_converged;
  figures.frames_reassembled = measured.frames_reassembled;
  figures.wrong_markers = static_cast<int>(report.result.incidents.size());
  figures.process_noise_scale = report.result.process_noise_scale.value_or(kNaN);
  figures.nis = measured.nis;
  figures.median_ms = measured.median_ms;
  figures.p99_ms = measured.p99_ms;
  figures.warnings = report.warnings.texts();
  return {std::move(figures), "", seconds};
}

EntryResult Failed(const std::string& reason, double seconds) {
  return {std::nullopt, reason, seconds};
}

Json ToJson(const EntryResult& result) {
  const Json seconds = Number(result.seconds, kMillisecond);
  if (!result.converted()) {
    return {{"state", "failed"}, {"reason", result.reason}, {"seconds", seconds}};
  }
  const EntryFigures& figures = *result.figures;
  return {
      {"state", "converted"},
      {"reason", nullptr},
      {"verdict", ToJson(figures.verdict)},
      {"frames", figures.frames},
      {"rate_hz", figures.rate},
      {"height_m", Number(figures.height)},
      {"height_source", TextOrNull(figures.height_source)},
      {"mass_kg", Number(figures.mass)},
      {"mass_source", TextOrNull(figures.mass_source)},
      {"subject", figures.subject ? Json(*figures.subject) : Json(nullptr)},
      {"converter", figures.converter},
      {"configuration", figures.configuration},
      {"markers_used", figures.markers_used},
      {"markers_absent", figures.markers_absent},
      {"markers_ignored", figures.markers_ignored},
      {"distance_mm",
       {{"mean", Number(figures.mean_mm)},
        {"p95", Number(figures.p95_mm)},
        {"max", Number(figures.max_mm)}}},
      {"worst_marker", TextOrNull(figures.worst_marker)},
      {"worst_marker_mm", Number(figures.worst_marker_mm)},
      {"frames_with_missing_markers", figures.frames_with_missing_markers},
      {"frames_not_converged", figures.frames_not_converged},
      {"frames_reassembled", figures.frames_reassembled},
      {"wrong_markers", figures.wrong_markers},
      {"process_noise_scale", Number(figures.process_noise_scale)},
      {"nis_over_degrees_of_freedom", Number(figures.nis)},
      {"ms_per_frame", {{"median", Number(figures.median_ms)}, {"p99", Number(figures.p99_ms)}}},
      {"seconds", seconds},
      {"warnings", figures.warnings}};
}

EntryResult ParseEntryResult(const Json& json) {
  EntryResult result;
  result.reason = ParseText(json.at("reason"));
  result.seconds = ParseNumber(json.at("seconds"));
  if (json.at("state") == "converted") result.figures = ParseFigures(json);
  return result;
}

}  // namespace mmm_converter
