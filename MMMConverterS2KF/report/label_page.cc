// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/label_page.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "MMMConverterS2KF/report/drawn_frames.h"
#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/label_summary.h"
#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "common/io/recording/marker_labels.h"
#include "common/judge/verdict.h"
#include "common/label/track/labelling.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// A coordinate after the other.
Json TrackJson(const MarkerSequence& markers, const DrawnFrames& drawn, int label) {
  Eigen::MatrixXd track(drawn.count(), 3);
  for (int i = 0; i < drawn.count(); ++i) {
    track.row(i) = markers.frame(drawn.frame(i)).col(label).transpose();
  }
  return ToJson(PackFloats(track));
}

// The column that is called so; -1: none.
int ColumnOf(const MarkerSequence& markers, const std::string& name) {
  for (int i = 0; i < markers.num_labels(); ++i) {
    if (NormalizeLabel(markers.labels()[i]) == NormalizeLabel(name)) return i;
  }
  return -1;
}

Json TracksOfNames(const LabelReport& report) {
  const MarkerSequence& before = report.input.recording.markers;
  const MarkerSequence after = Relabelled(report.found.points, before);
  const DrawnFrames drawn(before.num_frames());
  Json names = Json::array();
  for (int i = 0; i < after.num_labels(); ++i) {
    if (!report.found.points[i].is_named) continue;
    const int column = ColumnOf(before, after.labels()[i]);
    names.push_back({{"name", after.labels()[i]},
                     {"before", column < 0 ? Json(nullptr) : TrackJson(before, drawn, column)},
                     {"after", TrackJson(after, drawn, i)}});
  }
  return {{"frames", drawn.count()},
          {"every", drawn.every()},
          {"first_frame", report.input.first_frame},
          {"rate", before.rate()},
          {"first_time", before.first_time()},
          {"names", names}};
}

// Of a repair what it did; else what was found.
std::string SentenceOf(const FoundLabels& found) {
  if (!found.is_repair) return DescribeLabels(found);
  std::set<int> points;
  for (const LabelChange& change : found.changes) points.insert(change.point);
  const std::vector<std::string> missing = NamesNotFound(found.labelling);
  return fmt::format("{} of {} labels {} changed{}",
                     points.empty() ? "None" : std::to_string(points.size()),
                     found.labelling.names.size(), points.size() == 1 ? "was" : "were",
                     missing.empty() ? "" : fmt::format("; on no point: {}", FirstNames(missing)));
}

}  // namespace

std::string FormatLabelPage(const LabelReport& report) {
  Json figures = ToJson(report);
  figures["sentence"] =
      fmt::format("{}. Verdict: {}.", SentenceOf(report.found), DescribeVerdict(report.verdict));
  const std::string title =
      "Labels of " + std::filesystem::path(report.input.recording.file).filename().string();
  const std::string data = DataBlock("figures", FormatJson(figures)) +
                           DataBlock("tracks", FormatJsonLine(TracksOfNames(report)));
  return FormatPage(
      {.title = title,
       .styles = DynamicsStyles(),
       .content = LabelContent(),
       .data = data,
       .libraries = {{SceneLibrary(), SceneLibrarySha256()}, {PlotLibrary(), PlotLibrarySha256()}},
       .script = {LabelScript(), LabelScriptSha256()}});
}

}  // namespace mmm_converter
