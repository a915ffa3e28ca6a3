// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/label_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "MMMConverterS2KF/report/conversion_summary.h"
#include "common/label/track/labelling.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kProbabilityDecimals = 4;

/// What became of a name.
struct NameFigures {
  int frames = 0;
  std::set<int> points;  ///< of the recording
  double probability = 1;
};

std::vector<NameFigures> FiguresOfNames(const Labelling& labelling) {
  std::vector<NameFigures> figures(labelling.names.size());
  for (const NamedPiece& piece : labelling.pieces) {
    if (piece.name < 0) continue;
    NameFigures& name = figures[piece.name];
    name.frames += piece.end - piece.begin;
    name.points.insert(piece.point);
    name.probability = std::min(name.probability, piece.probability);
  }
  return figures;
}

std::string DescribeChange(const LabelReport& report, const LabelChange& change) {
  const MarkerSequence& markers = report.input.recording.markers;
  return fmt::format(
      "{} {}, frames {} to {} ({:.2f} to {:.2f} s)\n", change.from,
      change.to.empty() ? "is none of the markers"
                        : fmt::format("is {} ({:.3g})", change.to, change.probability),
      change.begin, change.end - 1, markers.time(change.begin), markers.time(change.end - 1));
}

std::string DescribeChanges(const LabelReport& report) {
  constexpr std::size_t kMostLines = 40;
  const std::vector<LabelChange>& changes = report.found.changes;
  if (changes.empty()) return "changed    nothing\n";
  std::string text;
  for (std::size_t i = 0; i < std::min(changes.size(), kMostLines); ++i) {
    text += (i == 0 ? "changed    " : "           ") + DescribeChange(report, changes[i]);
  }
  if (changes.size() > kMostLines) {
    text += fmt::format("           and {} more (all in --summary)\n", changes.size() - kMostLines);
  }
  return text;
}

std::string DescribePerson(const Person& person) {
  if (person.height.value <= 0) return person.height.source;
  std::string text = fmt::format("{:.3g} m ({})", person.height.value, person.height.source);
  if (person.subject && person.subject_file.empty()) {
    text += fmt::format(", calibrated on {}", person.subject->sources.empty()
                                                  ? "a labelled recording"
                                                  : person.subject->sources.front().recording);
  }
  return text;
}

// A line for each: how many of its names were found.
std::string DescribeOthers(const FoundLabels& found) {
  const std::vector<NameFigures> figures = FiguresOfNames(found.labelling);
  std::string text;
  for (const OtherBody& other : found.others) {
    const auto begin = figures.begin() + other.first_name;
    const auto end = figures.begin() + other.end_name;
    text += fmt::format(
        "{:<11}{} ({}): {} of {} names found\n", other.is_object ? "object" : "person", other.name,
        other.file,
        std::count_if(begin, end, [](const NameFigures& name) { return name.frames > 0; }),
        end - begin);
  }
  return text;
}

}  // namespace

std::string DescribeLabels(const FoundLabels& found) {
  const std::vector<std::string> not_found = NamesNotFound(found.labelling);
  const auto unnamed =
      std::count_if(found.points.begin(), found.points.end(),
                    [](const RelabelledPoint& point) { return point.label.starts_with('*'); });
  return fmt::format("{} of {} names found{}; {} without a name",
                     found.labelling.names.size() - not_found.size(), found.labelling.names.size(),
                     not_found.empty() ? "" : fmt::format(" (not: {})", FirstNames(not_found)),
                     unnamed == 1 ? "1 point stays" : fmt::format("{} points stay", unnamed));
}

std::string FormatLabelSummary(const LabelReport& report) {
  const Recording& recording = report.input.recording;
  const MarkerSequence& markers = recording.markers;
  std::string text =
      fmt::format("recording  {}: {}, {} frames at {:.6g} Hz, {} points\n", recording.file,
                  recording.format, markers.num_frames(), markers.rate(), markers.num_labels());
  text += fmt::format("person     {}\n", DescribePerson(report.found.person));
  text += DescribeOthers(report.found);
  text += fmt::format(
      "names      {}{}\n", DescribeLabels(report.found),
      report.found.setup.marker_set.empty() ? "" : "; marker set " + report.found.setup.marker_set);
  if (report.found.is_repair) text += DescribeChanges(report);
  if (std::isfinite(report.fit.mean_distance)) {
    text += fmt::format("distance   mean {:.1f} mm, named points from the person's markers\n",
                        kMillimetres * report.fit.mean_distance);
  }
  text += report.output.empty() ? "written    nothing; -o FILE writes the recording so\n"
                                : fmt::format("written    {}\n", report.output);
  return text + FormatVerdict(report.verdict);
}

Json LabelsJson(const FoundLabels& found, const MarkerSequence& markers, int first_frame) {
  const std::vector<NameFigures> figures = FiguresOfNames(found.labelling);
  Json names = Json::array();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    names.push_back({{"name", found.labelling.names[i]},
                     {"frames", figures[i].frames},
                     {"points", figures[i].points.size()},
                     {"least_probability", figures[i].frames == 0 ? Json(nullptr)
                                                                  : Number(figures[i].probability,
                                                                           kProbabilityDecimals)}});
  }
  Json unnamed = Json::array();
  for (const RelabelledPoint& point : found.points) {
    if (point.label.starts_with('*')) unnamed.push_back(point.label);
  }
  Json changes = Json::array();
  for (const LabelChange& change : found.changes) {
    changes.push_back({{"from", change.from},
                       {"to", TextOrNull(change.to)},
                       {"first_frame", first_frame + change.begin},
                       {"last_frame", first_frame + change.end - 1},
                       {"first_s", Number(markers.time(change.begin))},
                       {"last_s", Number(markers.time(change.end - 1))},
                       {"probability", Number(change.probability, kProbabilityDecimals)}});
  }
  return {{"marker_set", TextOrNull(found.setup.marker_set)},
          {"names", names},
          {"unnamed", unnamed},
          {"changes", changes}};
}

Json ToJson(const LabelReport& report) {
  const Recording& recording = report.input.recording;
  const Person& person = report.found.person;
  Json json = {{"program", SubjectProgram()},
               {"input",
                {{"file", recording.file},
                 {"format", recording.format},
                 {"subject", recording.subject},
                 {"motion", recording.motion()},
                 {"points", recording.markers.num_labels()}}},
               {"output", TextOrNull(report.output)},
               {"repair", report.found.is_repair},
               {"frames", recording.markers.num_frames()},
               {"rate_hz", recording.markers.rate()},
               {"height_m", person.height.value > 0 ? Number(person.height.value) : Json(nullptr)},
               {"height_source", person.height.source},
               {"subject", person.subject ? Json(person.subject->name) : Json(nullptr)}};
  for (const OtherBody& other : report.found.others) {
    json["others"].push_back({{"name", other.name},
                              {"file", other.file},
                              {"kind", other.is_object ? "object" : "person"}});
  }
  json.update(LabelsJson(report.found, recording.markers, report.input.first_frame));
  json["mean_distance_mm"] = std::isfinite(report.fit.mean_distance)
                                 ? Number(kMillimetres * report.fit.mean_distance)
                                 : Json(nullptr);
  json["verdict"] = ToJson(report.verdict);
  json["warnings"] = report.warnings.texts();
  return json;
}

}  // namespace mmm_converter
