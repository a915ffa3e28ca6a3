// SPDX-License-Identifier: MIT
#include "common/study/hiding.h"

#include <string>
#include <vector>

#include "common/motion/occlusion.h"
#include "common/support/units.h"

namespace mmm_converter {

HiddenMarkers DrawHidden(const Hiding& hiding, int num_markers, int num_frames,
                         std::uint64_t seed) {
  HiddenMarkers hidden = HiddenMarkers::Constant(num_markers, num_frames, false);
  if (hiding.amount == 0) return hidden;
  MarkerSequence markers(std::vector<std::string>(num_markers), num_frames, 1, 0);
  for (int k = 0; k < num_frames; ++k) markers.frame(k).setZero();
  if (hiding.model == HidingModel::kPaper) {
    markers = OccludeAtRandom(std::move(markers), {hiding.amount, hiding.mean_frames}, seed);
  } else {
    markers = OccludeShare(std::move(markers), hiding.amount, hiding.mean_frames, seed);
  }
  for (int k = 0; k < num_frames; ++k) {
    hidden.col(k) = markers.frame(k).row(0).transpose().array().isNaN();
  }
  return hidden;
}

MarkerSequence WithoutHidden(MarkerSequence recording, const std::vector<LabelIx>& labels,
                             const HiddenMarkers& hidden) {
  for (int k = 0; k < recording.num_frames(); ++k) {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (!hidden(static_cast<int>(i), k)) continue;
      recording.frame(k).col(labels[i]).setConstant(kNaN);
    }
  }
  return recording;
}

}  // namespace mmm_converter
