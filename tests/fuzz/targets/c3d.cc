// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>

#include "common/io/bytes/file_content.h"
#include "common/io/c3d/c3d_analog.h"
#include "common/io/c3d/c3d_content.h"
#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_file.h"
#include "common/io/c3d/c3d_points.h"
#include "common/io/c3d/c3d_relabelling.h"
#include "common/io/c3d/c3d_writer.h"
#include "common/support/error.h"
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
  const C3dAnalog analog = ReadC3dAnalog(file, &warnings);
  Require(ReadC3dAnalogSamples(&file, analog).rows() ==
              static_cast<Eigen::Index>(analog.channels.size()),
          "samples of each channel");
  ReadC3dForcePlates(file.parameters(), &warnings);
  ReadC3dEvents(file, &warnings);
  for (const C3dPointCounts& counts : CountC3dPoints(&file)) {
    Require(counts.seen + counts.marked_invalid + counts.at_origin + counts.no_position ==
                file.layout().frames,
            "counts that add up to the frames");
  }
}

/// Written as it is, it is the same; of a file without contradictions the points can change.
void Relabel(const std::string& path) {
  Warnings warnings;
  const C3dFile file(path, &warnings);
  const C3dLayout& layout = file.layout();
  const std::vector<std::string> names = C3dPointNames(file, &warnings);
  std::vector<C3dRelabelledPoint> points;
  points.reserve(names.size() + 1);
  for (int i = 0; i < layout.points; ++i) {
    points.push_back({names[i], i, {{0, layout.frames, i}}});
  }
  const std::string written = path + ".relabelled";
  try {
    WriteRelabelledC3d(path, points, written);
    Require(ReadFileContent(written) == ReadFileContent(path), "the same bytes");
    points.push_back({"a_new_point", 0, {{0, layout.frames, 0}}});
    points.front().label = "another_name";
    std::reverse(points.begin(), points.end());
    WriteRelabelledC3d(path, points, written);
  } catch (const Error&) {
    return;  // such as a label that is too long to be written
  }
  const C3dFile again(written);
  if (!warnings.empty()) return;
  Require(again.layout().frames == layout.frames, "the frames of the file that was relabelled");
  Require(C3dPointNames(again, nullptr).front() == "a_new_point", "the new label");
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
  Relabel(path);
}

}  // namespace mmm_converter::testing
