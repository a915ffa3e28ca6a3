// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/names_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/convert/marker_set_text.h"
#include "common/study/conversion_figures.h"
#include "common/support/text.h"

namespace mmm_converter {

std::string DescribeNames(const NamedMarkers& named) {
  std::map<std::string, std::vector<std::string>> left_out;  // by reason
  std::vector<std::pair<std::string, std::vector<std::string>>> changed;
  for (const NamedLabel& one : named.labels) {
    if (one.marker.empty()) {
      left_out[one.landmark.empty() ? "no landmark" : one.note].push_back(one.label);
    } else if (!one.note.empty()) {
      auto same = std::find_if(changed.begin(), changed.end(),
                               [&](const auto& other) { return other.first == one.note; });
      if (same == changed.end()) same = changed.insert(same, {one.note, {}});
      same->second.push_back(one.label);
    }
  }
  std::string text =
      fmt::format("{} of {} labels by their names", named.num_used(), named.labels.size());
  const char* separator = "; left out: ";
  for (const auto& [reason, labels] : left_out) {
    text += fmt::format("{}{} ({})", separator, reason, FirstNames(labels, 6));
    separator = ", ";
  }
  text += "\n";
  for (const auto& [note, labels] : changed) {
    text += fmt::format("           {}: {}\n", fmt::join(labels, ", "), note);
  }
  return text;
}

std::string FormatNames(const NamedMarkers& named) {
  std::size_t width = 5;
  for (const NamedLabel& one : named.labels) width = std::max(width, one.label.size());
  std::string text;
  for (const NamedLabel& one : named.labels) {
    const std::string landmark = one.landmark.empty() ? "no landmark" : one.landmark;
    text += fmt::format("  {:<{}}  {}{}{}\n", one.label, width, one.marker.empty() ? "- " : "",
                        landmark, one.note.empty() ? "" : ": " + one.note);
  }
  return text;
}

Json NamesJson(const NamedMarkers& named) {
  Json list = Json::array();
  for (const NamedLabel& one : named.labels) {
    list.push_back({{"label", one.label},
                    {"landmark", TextOrNull(one.landmark)},
                    {"marker", TextOrNull(one.marker)},
                    {"note", TextOrNull(one.note)}});
  }
  return list;
}

std::string FormatUsedSet(const ConversionPlan& plan) {
  MarkerSet set;
  set.name = plan.setup.marker_set.empty() ? "list" : plan.setup.marker_set;
  std::vector<std::string> remarks, tail;
  std::vector<NamedLabel> labels;
  if (const auto& names = plan.input.names) {
    set = names->set;
    labels = names->labels;
  } else {
    for (std::size_t i = 0; i < plan.setup.assignments().size(); ++i) {
      const MarkerAssignment& one = plan.setup.assignments()[i];
      set.pairs.push_back({LabelOf(plan, static_cast<int>(i)),
                           plan.setup.model->markers()[one.marker].name, one.noise_scale});
    }
  }
  for (const MarkerPlace& place : set.places) {
    const auto own = std::find_if(labels.begin(), labels.end(),
                                  [&](const auto& one) { return one.marker == place.marker; });
    remarks.push_back(own == labels.end() ? "" : own->landmark);
  }
  for (const NamedLabel& one : labels) {
    if (!one.marker.empty()) continue;
    tail.push_back(
        fmt::format("{}: left out, {}", one.label, one.note.empty() ? "no landmark" : one.note));
  }
  const std::string file = std::filesystem::path(plan.input.recording.file).filename().string();
  return FormatMarkerSet(
      set,
      fmt::format("What the labels of {} were taken for. Places are in mm of the "
                  "model of 1 m, in axes of the segment.",
                  file),
      remarks, tail);
}

}  // namespace mmm_converter
