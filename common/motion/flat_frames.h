// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Frames in which a foot lies flat by these columns of its markers: each is near the lowest place
/// that it has in the recording, z up, and hardly moves upwards or downwards.
std::vector<int> FlatFrames(const MarkerSequence& recording, const std::vector<int>& labels);

}  // namespace mmm_converter
