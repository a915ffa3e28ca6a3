// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Standard deviation of the white noise of marker positions, each coordinate [m], from their third
/// differences over some frames at a time: where markers are quietest, which is noise rather than
/// motion. labels: the columns that count. NaN: no marker is seen long enough.
double MeasureMarkerNoise(const MarkerSequence& recording, const std::vector<LabelIx>& labels);

}  // namespace mmm_converter
