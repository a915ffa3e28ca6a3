// SPDX-License-Identifier: MIT
#include "common/io/recording/marker_recording.h"

#include <fmt/format.h>

#include <numeric>
#include <set>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {

void CheckFrameRate(double rate) {
  if (!IsFrameRate(rate)) throw Error("rate: must be from 1 to 100000 frames a second");
}

Recording MakeRecording(MarkerSequence markers, const std::string& name) {
  CheckFrameRate(markers.rate());
  if (markers.num_frames() == 0 || markers.num_labels() == 0) {
    throw Error("markers: there are none");
  }
  std::set<std::string> known;
  for (const std::string& label : markers.labels()) {
    if (known.insert(label).second) continue;
    throw Error(
        fmt::format("labels: {} is there twice; each marker needs a name of its own", label));
  }
  for (int k = 0; k < markers.num_frames(); ++k) {
    if (!std::as_const(markers).frame(k).array().isInf().any()) continue;
    throw Error("markers: infinite; a marker that is not seen is NaN");
  }
  Recording recording;
  recording.file = name;
  recording.format = "arrays";
  recording.unit = "m";
  recording.points.resize(static_cast<std::size_t>(markers.num_labels()));
  std::iota(recording.points.begin(), recording.points.end(), 0);
  recording.markers = std::move(markers);
  return recording;
}

}  // namespace mmm_converter
