// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/info_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace mmm_converter {
namespace {

constexpr int kShownDecimals = 6;  // of a metre

struct LabelStatistics {
  int frames_seen = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // [m]
};

LabelStatistics StatisticsOf(const MarkerSequence& markers, int label) {
  LabelStatistics statistics;
  for (int k = 0; k < markers.num_frames(); ++k) {
    const Eigen::Vector3d p = markers.frame(k).col(label);
    if (!IsSeen(p)) continue;
    ++statistics.frames_seen;
    statistics.mean += p;
  }
  if (statistics.frames_seen > 0) statistics.mean /= statistics.frames_seen;
  return statistics;
}

}  // namespace

std::string FormatMarkers(const MarkerSequence& markers) {
  std::size_t width = 5;
  for (const std::string& label : markers.labels()) width = std::max(width, label.size());
  std::string text = fmt::format("  {:<{}}  seen in  mean position [m]\n", "label", width);
  for (int i = 0; i < markers.num_labels(); ++i) {
    const LabelStatistics statistics = StatisticsOf(markers, i);
    text += fmt::format("  {:<{}}  {:>7}", markers.labels()[i], width, statistics.frames_seen);
    if (statistics.frames_seen > 0) {
      text += fmt::format("  {:8.3f} {:8.3f} {:8.3f}", statistics.mean.x(), statistics.mean.y(),
                          statistics.mean.z());
    }
    text += "\n";
  }
  return text;
}

Json MarkersJson(const MarkerSequence& markers) {
  Json list = Json::array();
  for (int i = 0; i < markers.num_labels(); ++i) {
    const LabelStatistics statistics = StatisticsOf(markers, i);
    Json entry = {{"label", markers.labels()[i]},
                  {"frames_seen", statistics.frames_seen},
                  {"mean_position_m", nullptr}};
    if (statistics.frames_seen > 0) {
      Json& mean = entry["mean_position_m"] = Json::array();
      for (const double x : statistics.mean) mean.push_back(Number(x, kShownDecimals));
    }
    list.push_back(entry);
  }
  return list;
}

}  // namespace mmm_converter
