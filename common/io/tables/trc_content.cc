// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_content.h"

#include <memory>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/tables/trc_reader.h"

namespace mmm_converter {

RecordingContent ReadTrcContent(const std::string& file, const ContentOptions& /*options*/,
                                Warnings* warnings) {
  TrcFile trc = ParseTrc(ReadFileContent(file), file, warnings);
  RecordingContent content;
  content.format = "TRC";
  content.labels = trc.markers.labels();
  content.unit = trc.unit;
  content.usual_up_axes = {UpAxis::kY, UpAxis::kZ};
  content.rate = trc.markers.rate();
  content.first_frame = trc.first_frame;
  content.declared_frames = trc.declared_frames;
  const auto all = std::make_shared<const MarkerSequence>(std::move(trc.markers));
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

}  // namespace mmm_converter
