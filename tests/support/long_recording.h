// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// The frame of a recording of `length` frames that plays at `step`, forwards, backwards, forwards,
/// ...: no jump at its ends.
inline int FrameBackAndForth(int step, int length) {
  const int last = std::max(length - 1, 1);
  const int phase = step % (2 * last);
  return std::min(phase < last ? phase : 2 * last - phase, length - 1);
}

/// A recording played back and forth until it has `frames` frames.
inline MarkerSequence Lengthen(const MarkerSequence& markers, int frames) {
  MarkerSequence longer(markers.labels(), frames, markers.rate(), markers.first_time());
  for (int k = 0; k < frames; ++k) {
    longer.frame(k) = markers.frame(FrameBackAndForth(k, markers.num_frames()));
  }
  return longer;
}

}  // namespace mmm_converter
