// SPDX-License-Identifier: MIT
#include "common/io/recording/recording.h"

#include "common/io/recording/recording_formats.h"
#include "tests/fuzz/fuzz_target.h"

namespace mmm_converter::testing {

void ReadRecordingBytes(std::string_view bytes) {
  const std::string path = FileOf(bytes);
  Warnings warnings;
  const RecordingFormat& format = FormatOfContent(path);
  if (format.holds_motions) ReadAllMotions(path, {}, &warnings);
  const MarkerSequence markers = ReadRecording(path, {}, &warnings).markers;
  Require(markers.num_labels() > 0 && markers.num_frames() > 0, "markers and frames");
  Require(IsFrameRate(markers.rate()), "a frame rate");
  for (int k = 0; k < markers.num_frames(); ++k) {
    for (int label = 0; label < markers.num_labels(); ++label) {
      const Eigen::Vector3d p = markers.frame(k).col(label);
      Require(p.allFinite() || p.array().isNaN().all(), "a position or none");
    }
  }
}

}  // namespace mmm_converter::testing
