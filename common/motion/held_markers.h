// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Frames [begin, end) in which a marker was not seen and has its last value instead.
struct HeldStretch {
  LabelIx label;
  int begin = 0;
  int end = 0;
};

/// Where gaps were filled with the last value: a marker stays where it is to the last digit in five
/// frames or more, while others move, and then either jumps by far more than it ever moves in a
/// frame, or stays while the markers that keep their distance to it elsewhere leave it. A marker at
/// rest does neither. By label, then by time.
std::vector<HeldStretch> FindHeldMarkers(const MarkerSequence& markers);

}  // namespace mmm_converter
