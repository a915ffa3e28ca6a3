// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

enum class HidingModel { kPaper, kStationary };

/// Which markers are hidden from converters.
struct Hiding {
  HidingModel model = HidingModel::kPaper;
  /// kPaper: probability with which a visible marker hides in a frame; the paper has 0.005. All
  /// markers are visible at first; on average a share p m / (1 + p m) is hidden once it is
  /// stationary. kStationary: share that is hidden in every frame; a marker that comes back has a
  /// random visible one hide in its place. 0: none.
  double amount = 0;
  double mean_frames = 100;  ///< for which one hides: a Poisson distributed number of frames
};

/// Markers x frames: true where the marker is hidden.
using HiddenMarkers = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

HiddenMarkers DrawHidden(const Hiding& hiding, int num_markers, int num_frames, std::uint64_t seed);

/// The recording without the hidden ones; hidden.row(i) is for labels[i].
MarkerSequence WithoutHidden(MarkerSequence recording, const std::vector<LabelIx>& labels,
                             const HiddenMarkers& hidden);

}  // namespace mmm_converter
