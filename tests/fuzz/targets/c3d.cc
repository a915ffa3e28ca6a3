// SPDX-License-Identifier: MIT
#include <numeric>

#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_content.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_points.h"
#include "common/io/c3d/c3d_writer.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {
namespace {

MarkerSequence ReadAllPoints(const std::string& path, bool ignore_residuals) {
  Warnings warnings;
  const RecordingContent content =
      ReadC3dContent(path, {.ignore_residuals = ignore_residuals}, &warnings);
  std::vector<int> points(content.labels.size());
  std::iota(points.begin(), points.end(), 0);
  return content.read(points, content.labels, IsFrameRate(content.rate) ? content.rate : 100);
}

/// What `info` says of the file, which may hold no point and no frame.
void Describe(const std::string& path) {
  Warnings warnings;
  C3dFile file(path, &warnings);
  Require(C3dPointNames(file, &warnings).size() == static_cast<std::size_t>(file.layout().points),
          "a name for each point");
  C3dOutputNames(file);
  ReadC3dAnalog(file, &warnings);
  ReadC3dForcePlates(file.parameters(), &warnings);
  ReadC3dEvents(file, &warnings);
  for (const C3dPointCounts& counts : CountC3dPoints(&file)) {
    Require(counts.seen + counts.marked_invalid + counts.at_origin + counts.no_position ==
                file.layout().frames,
            "counts that add up to the frames");
  }
}

}  // namespace

void ReadC3dBytes(std::string_view bytes) {
  const std::string path = FileOf(bytes);
  Describe(path);
  ReadAllPoints(path, true);
  const MarkerSequence read = ReadAllPoints(path, false);
  const std::string written = path + ".written";
  WriteC3d(written, read);
  const MarkerSequence again = ReadAllPoints(written, false);
  Require(again.labels() == read.labels(), "the labels that were written");
  Require(again.num_frames() == read.num_frames(), "the frames that were written");
}

}  // namespace mmm_converter::testing
