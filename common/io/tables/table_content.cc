// SPDX-License-Identifier: MIT
#include "common/io/tables/table_content.h"

#include <memory>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/tables/motive_csv.h"
#include "common/io/tables/nexus_csv.h"
#include "common/io/tables/points_csv.h"
#include "common/io/tables/qtm_tsv.h"
#include "common/io/tables/trc_reader.h"

namespace mmm_converter {
namespace {

RecordingContent ContentOf(MarkerTable table, const char* format, std::vector<UpAxis> usual_up) {
  RecordingContent content;
  content.format = format;
  content.labels = table.markers.labels();
  content.unit = std::move(table.unit);
  content.usual_up_axes = std::move(usual_up);
  content.rate = table.has_rate ? table.markers.rate() : 0;
  content.first_frame = table.first_frame;
  content.declared_frames = table.declared_frames;
  const auto all = std::make_shared<const MarkerSequence>(std::move(table.markers));
  content.read = [all](const std::vector<int>& points, const std::vector<std::string>& labels,
                       double rate) {
    MarkerSequence chosen(labels, all->num_frames(), rate, all->first_time());
    for (int k = 0; k < all->num_frames(); ++k) {
      chosen.frame(k) = all->frame(k)(Eigen::all, points);
    }
    return chosen;
  };
  return content;
}

}  // namespace

RecordingContent ReadTrcContent(const std::string& file, const ContentOptions& /*options*/,
                                Warnings* warnings) {
  return ContentOf(ParseTrc(ReadFileContent(file), file, warnings), "TRC",
                   {UpAxis::kY, UpAxis::kZ});
}

RecordingContent ReadNexusCsvContent(const std::string& file, const ContentOptions& /*options*/,
                                     Warnings* warnings) {
  return ContentOf(ParseNexusCsv(ReadFileContent(file), file, warnings), "Nexus CSV", {UpAxis::kZ});
}

RecordingContent ReadMotiveCsvContent(const std::string& file, const ContentOptions& /*options*/,
                                      Warnings* warnings) {
  return ContentOf(ParseMotiveCsv(ReadFileContent(file), file, warnings), "Motive CSV",
                   {UpAxis::kY, UpAxis::kZ});
}

RecordingContent ReadQtmTsvContent(const std::string& file, const ContentOptions& /*options*/,
                                   Warnings* warnings) {
  return ContentOf(ParseQtmTsv(ReadFileContent(file), file, warnings), "QTM TSV", {UpAxis::kZ});
}

RecordingContent ReadPointsCsvContent(const std::string& file, const ContentOptions& /*options*/,
                                      Warnings* warnings) {
  return ContentOf(ParsePointsCsv(ReadFileContent(file), file, warnings), "CSV of points",
                   {UpAxis::kZ, UpAxis::kY});
}

}  // namespace mmm_converter
