// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "common/label/track/labelling.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter::testing {

/// A labelled recording made hard to label, and the truth.
struct UnnamedPoints {
  MarkerSequence points;  ///< columns "*1", "*2", ..., shuffled in every frame
  std::vector<std::vector<int>>
      truth;  ///< by frame and column: label of the recording, -1: a ghost
};

struct UnnamedErrors {
  double hidden = 0;  ///< share of the markers, in blocks of 0.5 s on average
  int ghosts = 0;     ///< a frame; half of them 3 to 15 cm from a marker, for 0.2 s on average
  bool shuffled = true;
};

UnnamedPoints MakeUnnamed(const MarkerSequence& recording, const UnnamedErrors& errors,
                          std::uint64_t seed);

/// Shares of the points that are markers.
struct LabelScore {
  double right = 0, wrong = 0;  ///< the rest is left without a name
  double ghosts_named = 0;      ///< per point that is a marker
};

/// names[i] is the label of the recording that name i of the labelling stands for.
LabelScore ScoreLabels(const UnnamedPoints& made, const Labelling& labelling,
                       const std::vector<int>& names);

}  // namespace mmm_converter::testing
