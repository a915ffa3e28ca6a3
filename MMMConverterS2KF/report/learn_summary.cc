// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/learn_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "common/pipeline/person_calibration.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr int kLearntDecimals = 4;

std::string DescribeSegments(const LearnedMarkers& learned) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> labels;
  for (const LearnedMarker& marker : learned.markers) {
    if (!marker.left_out.empty()) continue;
    std::vector<std::string>& of_segment = labels[marker.segment];
    if (of_segment.empty()) order.push_back(marker.segment);
    of_segment.push_back(marker.label);
  }
  std::string text;
  for (const std::string& segment : order) {
    text += fmt::format("           {:<26} {}\n", segment, fmt::join(labels[segment], " "));
  }
  return text;
}

std::size_t CountLeftOut(const LearnedMarkers& learned) {
  return static_cast<std::size_t>(
      std::count_if(learned.markers.begin(), learned.markers.end(),
                    [](const LearnedMarker& marker) { return !marker.left_out.empty(); }));
}

}  // namespace

std::string FormatLearnSummary(const LearnReport& report) {
  std::string text;
  for (const Input& input : report.inputs) {
    const MarkerSequence& markers = input.recording.markers;
    text += fmt::format("recording  {}: {}, {} frames at {:.6g} Hz, {} labels\n",
                        input.recording.file, input.recording.format, markers.num_frames(),
                        markers.rate(), markers.num_labels());
  }
  const LearnedMarkers& learned = report.learned;
  text += fmt::format("person     {:.3g} m ({})\n", report.person.height.value,
                      report.person.height.source);
  text += fmt::format(
      "learnt     {} of {} labels, on {} frames; these are {:.1f} mm from their places\n",
      learned.markers.size() - CountLeftOut(learned), learned.markers.size(), learned.frames,
      kMillimetres * learned.mean_distance);
  text += DescribeSegments(learned);
  bool is_first = true;
  for (const LearnedMarker& marker : learned.markers) {
    if (marker.left_out.empty()) continue;
    text += fmt::format("{}{}: {}\n", is_first ? "left out   " : "           ", marker.label,
                        marker.left_out);
    is_first = false;
  }
  if (report.output.empty()) return text;
  return text + fmt::format("written    {}; use it with --marker-set\n", report.output);
}

std::string DescribeLearntSet(const LearnReport& report) {
  const LearnedMarkers& learned = report.learned;
  std::string left_out;
  for (const LearnedMarker& marker : learned.markers) {
    if (marker.left_out.empty()) continue;
    left_out += fmt::format("{}{} ({})", left_out.empty() ? "Left out: " : "; ", marker.label,
                            marker.left_out);
  }
  return fmt::format(
             "Of {} labels, {} were learnt on {} frames; there they are {:.1f} mm from their "
             "places "
             "in the mean. Below, the recordings are converted with the set: the body wears the "
             "markers where they were learnt.\n\n",
             learned.markers.size(), learned.markers.size() - CountLeftOut(learned), learned.frames,
             kMillimetres * learned.mean_distance) +
         left_out;
}

Json ToJson(const LearnReport& report) {
  Json inputs = Json::array();
  for (const Input& input : report.inputs) inputs.push_back(input.recording.file);
  Json markers = Json::array();
  for (const LearnedMarker& marker : report.learned.markers) {
    Json place = nullptr;
    if (!marker.segment.empty()) {
      place = Json::array();
      for (int i = 0; i < 3; ++i) place.push_back(Number(kMillimetres * marker.p_SM[i]));
    }
    markers.push_back({{"label", marker.label},
                       {"segment", marker.segment.empty() ? Json(nullptr) : Json(marker.segment)},
                       {"place_mm", place},
                       {"scatter_mm", Number(kMillimetres * marker.scatter)},
                       {"probability", Number(marker.probability, kLearntDecimals)},
                       {"left_out", TextOrNull(marker.left_out)}});
  }
  return {{"program", SubjectProgram()},
          {"inputs", inputs},
          {"output", report.output},
          {"height_m", Number(report.person.height.value)},
          {"height_source", report.person.height.source},
          {"frames", report.learned.frames},
          {"mean_distance_mm", Number(kMillimetres * report.learned.mean_distance)},
          {"markers", markers},
          {"warnings", report.warnings.texts()}};
}

}  // namespace mmm_converter
