// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// The nodes of a model whose translation is a length of the body: those that set a tracked joint
/// apart from the one above it, with a used marker below. What lies behind the last joint only
/// moves markers, and is left to their offsets.
struct SegmentLengths {
  std::vector<int> segments;                ///< indices of the model
  std::vector<std::pair<int, int>> mirror;  ///< indices into segments: left and right of one length
  /// Each segment stands there three times in a row, for its sizes along x, y and z.
  bool are_of_axes = false;
};

/// "femur_r"; "femur_r y" of axes.
std::string LengthName(const KinematicModel& model, const SegmentLengths& lengths, int length);

/// joints, markers: the tracked and used ones, indices of the model. Left and right are told by
/// their names: "L..." and "R..." or "Left..." and "Right...".
SegmentLengths FindSegmentLengths(const KinematicModel& model, const std::vector<int>& joints,
                                  const std::vector<MarkerIx>& markers);

}  // namespace mmm_converter
