// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/entry_result.h"

#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "common/study/conversion_figures.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kMillisecond = 3;  // decimals of seconds

using Report = ConversionReport;
using Figures = EntryFigures;

Json ValueOf(int value) { return value; }
Json ValueOf(double value) { return Number(value); }
Json ValueOf(const std::string& value) { return TextOrNull(value); }

void Parse(const Json& json, int* value) {
  *value = static_cast<int>(ParseInteger(json, 0, std::numeric_limits<int>::max()));
}
void Parse(const Json& json, double* value) { *value = json.is_null() ? kNaN : json.get<double>(); }
void Parse(const Json& json, std::string* value) {
  *value = json.is_null() ? std::string() : json.get<std::string>();
}

// A figure of an entry: beside its member, the only place that names it.
template <typename Report, typename Figures>
struct FieldOfReport {
  Json::json_pointer place;  // in a journal's line; with . between, the column of tables
  std::function<void(const Report&, Figures*)> take;
  std::function<Json(const Figures&)> write;
  std::function<void(const Json&, Figures*)> read;
};
using Field = FieldOfReport<Report, Figures>;
using RobotField = FieldOfReport<RetargetReport, RobotFigures>;

template <typename Report, typename Figures, typename Value, typename Of>
FieldOfReport<Report, Figures> MakeField(const char* place, Value Figures::*member, Of of) {
  return {Json::json_pointer(place),
          [member, of](const Report& report, Figures* figures) {
            figures->*member = static_cast<Value>(of(report));
          },
          [member](const Figures& figures) { return ValueOf(figures.*member); },
          [member](const Json& json, Figures* figures) { Parse(json, &(figures->*member)); }};
}

template <typename Value, typename Of>
Field FieldOf(const char* place, Value Figures::*member, Of of) {
  return MakeField<Report, Figures>(place, member, of);
}

template <typename Value, typename Of>
RobotField RobotFieldOf(const char* place, Value RobotFigures::*member, Of of) {
  return MakeField<RetargetReport, RobotFigures>(place, member, of);
}

double WorstDistance(const Report& report) {
  const int worst = report.figures.worst_marker;
  if (worst < 0) return kNaN;
  return kMillimetres * report.figures.of_markers[static_cast<std::size_t>(worst)].mean;
}

const std::vector<Field>& Fields() {
  using R = const Report&;
  static const std::vector<Field> fields = {
      FieldOf("/frames", &Figures::frames,
              [](R r) { return r.plan.input.recording.markers.num_frames(); }),
      FieldOf("/rate_hz", &Figures::rate,
              [](R r) { return r.plan.input.recording.markers.rate(); }),
      FieldOf("/height_m", &Figures::height,
              [](R r) { return r.plan.object ? kNaN : r.plan.person.height.value; }),
      FieldOf("/height_source", &Figures::height_source,
              [](R r) { return r.plan.object ? "" : r.plan.person.height.source; }),
      FieldOf("/mass_kg", &Figures::mass,
              [](R r) { return r.plan.object ? kNaN : r.plan.person.mass.value; }),
      FieldOf("/mass_source", &Figures::mass_source,
              [](R r) { return r.plan.object ? "" : r.plan.person.mass.source; }),
      FieldOf("/subject", &Figures::subject,
              [](R r) { return r.plan.person.subject ? r.plan.person.subject->name : ""; }),
      FieldOf("/converter", &Figures::converter, [](R r) { return r.plan.converter.config.type; }),
      FieldOf(
          "/configuration", &Figures::configuration,
          [](R r) { return std::filesystem::path(r.plan.converter.config.file).stem().string(); }),
      FieldOf("/markers_used", &Figures::markers_used,
              [](R r) { return r.plan.setup.assignments().size(); }),
      FieldOf("/markers_absent", &Figures::markers_absent,
              [](R r) { return r.plan.setup.mapping.absent_markers.size(); }),
      FieldOf("/markers_ignored", &Figures::markers_ignored,
              [](R r) { return r.plan.setup.mapping.ignored_labels.size(); }),
      FieldOf("/distance_mm/mean", &Figures::mean_mm,
              [](R r) { return kMillimetres * r.figures.distance.mean; }),
      FieldOf("/distance_mm/p95", &Figures::p95_mm,
              [](R r) { return kMillimetres * r.figures.distance.p95; }),
      FieldOf("/distance_mm/max", &Figures::max_mm,
              [](R r) { return kMillimetres * r.figures.distance.max; }),
      FieldOf("/worst_marker", &Figures::worst_marker,
              [](R r) {
                return r.figures.worst_marker < 0 ? "" : LabelOf(r.plan, r.figures.worst_marker);
              }),
      FieldOf("/worst_marker_mm", &Figures::worst_marker_mm, WorstDistance),
      FieldOf("/frames_with_missing_markers", &Figures::frames_with_missing_markers,
              [](R r) { return r.figures.frames_with_missing_markers; }),
      FieldOf("/frames_not_converged", &Figures::frames_not_converged,
              [](R r) { return r.figures.frames_not_converged; }),
      FieldOf("/frames_reassembled", &Figures::frames_reassembled,
              [](R r) { return r.figures.frames_reassembled; }),
      FieldOf("/wrong_markers", &Figures::wrong_markers,
              [](R r) { return r.result.incidents.size(); }),
      FieldOf("/process_noise_scale", &Figures::process_noise_scale,
              [](R r) { return r.result.process_noise_scale.value_or(kNaN); }),
      FieldOf("/nis_over_degrees_of_freedom", &Figures::nis, [](R r) { return r.figures.nis; }),
      FieldOf("/ms_per_frame/median", &Figures::median_ms, [](R r) { return r.figures.median_ms; }),
      FieldOf("/ms_per_frame/p99", &Figures::p99_ms, [](R r) { return r.figures.p99_ms; })};
  return fields;
}

const std::vector<RobotField>& RobotFields() {
  using R = const RetargetReport&;
  using F = RobotFigures;
  static const std::vector<RobotField> fields = {
      RobotFieldOf("/name", &F::name, [](R r) { return r.robot.model.name(); }),
      RobotFieldOf("/slide", &F::slide, [](R r) { return r.figures.slide; }),
      RobotFieldOf("/toe_slide_30_hz", &F::toe_slide, [](R r) { return r.figures.toe_slide; }),
      RobotFieldOf("/penetration_mm", &F::penetration_mm,
                   [](R r) { return kMillimetres * r.figures.penetration; }),
      RobotFieldOf("/floating_mm", &F::floating_mm,
                   [](R r) { return kMillimetres * r.figures.floating; }),
      RobotFieldOf("/direction_deg", &F::direction_deg,
                   [](R r) { return kDegrees * r.figures.direction; }),
      RobotFieldOf("/direction_p95_deg", &F::direction_p95_deg,
                   [](R r) { return kDegrees * r.figures.direction95; }),
      RobotFieldOf("/position_limits_broken", &F::position_breaks,
                   [](R r) { return r.figures.position_breaks; }),
      RobotFieldOf("/velocity_limits_broken", &F::velocity_breaks,
                   [](R r) { return r.figures.velocity_breaks; }),
      RobotFieldOf("/acceleration_rad_s2", &F::acceleration,
                   [](R r) { return r.figures.acceleration; })};
  return fields;
}

}  // namespace

EntryResult Converted(const ConversionReport& report, const RetargetReport* robot, double seconds) {
  EntryFigures figures;
  figures.verdict = robot != nullptr ? robot->verdict : report.verdict;
  for (const Field& field : Fields()) field.take(report, &figures);
  figures.warnings = (robot != nullptr ? robot->warnings : report.warnings).texts();
  if (robot != nullptr) {
    figures.robot.emplace();
    for (const RobotField& field : RobotFields()) field.take(*robot, &*figures.robot);
  }
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
  Json json = {
      {"state", "converted"}, {"reason", nullptr}, {"verdict", ToJson(result.figures->verdict)}};
  for (const Field& field : Fields()) json[field.place] = field.write(*result.figures);
  json["rate_hz"] = result.figures->rate;  // as the recording has it
  if (const auto& robot = result.figures->robot) {
    for (const RobotField& field : RobotFields()) json["robot"][field.place] = field.write(*robot);
  }
  json["seconds"] = seconds;
  json["warnings"] = result.figures->warnings;
  return json;
}

EntryResult ParseEntryResult(const Json& json) {
  EntryResult result;
  Parse(json.at("reason"), &result.reason);
  Parse(json.at("seconds"), &result.seconds);
  if (json.at("state") != "converted") return result;
  EntryFigures figures;
  const Json& verdict = json.at("verdict");
  figures.verdict.level = ParseVerdictLevel(verdict.at("level").get<std::string>());
  verdict.at("reasons").get_to(figures.verdict.reasons);
  for (const Field& field : Fields()) field.read(json.at(field.place), &figures);
  if (const auto robot = json.find("robot"); robot != json.end()) {
    figures.robot.emplace();
    for (const RobotField& field : RobotFields()) {
      field.read(robot->at(field.place), &*figures.robot);
    }
  }
  json.at("warnings").get_to(figures.warnings);
  result.figures = std::move(figures);
  return result;
}

}  // namespace mmm_converter
