// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// The slope of the ramp on which feet stand by these columns of their markers, by which heights
/// grow with x and y; zero: they stand on one level, on stairs, or not often enough to tell.
Eigen::Vector2d FindRamp(const MarkerSequence& recording, const std::vector<int>& labels);

/// Frames in which a foot lies flat by these columns of its markers: each is near the lowest place
/// above the ramp that it has in the recording, z up, and hardly moves upwards or downwards.
std::vector<int> FlatFrames(const MarkerSequence& recording, const std::vector<int>& labels,
                            const Eigen::Vector2d& ramp = Eigen::Vector2d::Zero());

}  // namespace mmm_converter
