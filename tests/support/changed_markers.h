// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/motion/hiding.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter::testing {

/// @throws Error for a label that the recording does not have.
inline int IndexOf(const MarkerSequence& sequence, const std::string& label) {
  const int index = sequence.FindLabel(label);
  if (index < 0) throw Error("marker '" + label + "' is not in the recording");
  return index;
}

/// Hides markers as HidingModel says.
inline MarkerSequence Hide(const Hiding& hiding, MarkerSequence sequence, std::uint64_t seed) {
  std::vector<LabelIx> labels;
  labels.reserve(static_cast<std::size_t>(sequence.num_labels()));
  for (int i = 0; i < sequence.num_labels(); ++i) labels.emplace_back(i);
  const HiddenMarkers hidden =
      DrawHidden(hiding, sequence.num_labels(), sequence.num_frames(), seed);
  return WithoutHidden(std::move(sequence), labels, hidden);
}

struct RandomOcclusion {
  double probability = 0.005;
  double mean_frames = 100;
};
inline MarkerSequence OccludeAtRandom(MarkerSequence sequence, const RandomOcclusion& occlusion,
                                      std::uint64_t seed) {
  return Hide({HidingModel::kPaper, occlusion.probability, occlusion.mean_frames},
              std::move(sequence), seed);
}

inline MarkerSequence OccludeShare(MarkerSequence sequence, double share, double mean_frames,
                                   std::uint64_t seed) {
  return Hide({HidingModel::kStationary, share, mean_frames}, std::move(sequence), seed);
}

/// Hides `labels` in frames [begin, end).
inline MarkerSequence HideMarkers(MarkerSequence sequence, const std::vector<std::string>& labels,
                                  int begin, int end) {
  for (const std::string& label : labels) {
    const int index = IndexOf(sequence, label);
    for (int k = begin; k < end; ++k) sequence.frame(k).col(index).setConstant(kNaN);
  }
  return sequence;
}

/// Hides all markers in frames [begin, end).
inline MarkerSequence HideAllMarkers(MarkerSequence sequence, int begin, int end) {
  for (int k = begin; k < end; ++k) sequence.frame(k).setConstant(kNaN);
  return sequence;
}

/// Each of two markers bears the other's label in frames [begin, end).
inline MarkerSequence SwapMarkers(MarkerSequence sequence, const std::string& a,
                                  const std::string& b, int begin, int end) {
  const int index_a = IndexOf(sequence, a);
  const int index_b = IndexOf(sequence, b);
  for (int k = begin; k < end; ++k) {
    auto frame = sequence.frame(k);
    frame.col(index_a).swap(frame.col(index_b));
  }
  return sequence;
}

}  // namespace mmm_converter::testing
