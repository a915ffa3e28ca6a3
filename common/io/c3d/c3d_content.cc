// SPDX-License-Identifier: MIT
#include "common/io/c3d/c3d_content.h"

#include <algorithm>
#include <memory>

#include "common/io/c3d/c3d_reader.h"

namespace mmm_converter {

bool LooksLikeC3d(std::string_view start) {
  const std::size_t first = start.find_first_not_of('\0');
  return first != std::string_view::npos && first + 1 < start.size() &&
         static_cast<unsigned char>(start[first]) < ' ' && start[first + 1] == '\x50';
}

RecordingContent ReadC3dContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings) {
  const auto reader = std::make_shared<C3dReader>(file, warnings);
  const C3dInfo& info = reader->info();
  RecordingContent content;
  content.format = "C3D";
  content.labels = info.labels;
  content.outputs = info.outputs;
  content.label_prefixes = info.label_prefixes;
  content.marks_points_valid = true;
  content.unit = info.unit;
  content.stated_up = info.up;
  content.usual_up_axes = {UpAxis::kZ};
  content.rate = info.layout.rate;
  content.first_frame = info.layout.first_frame;
  content.declared_frames = info.layout.declared_frames;
  content.comment = info.comment;
  content.origin = info.origin;
  content.stated_size = info.stated_size;
  content.read = [reader, ignore_residuals = options.ignore_residuals](
                     const std::vector<int>& points, const std::vector<std::string>& labels,
                     double rate) {
    return reader->ReadPoints(points, labels, rate, ignore_residuals);
  };
  return content;
}

}  // namespace mmm_converter
