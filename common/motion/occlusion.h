// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// The paper's occlusion: in every frame each visible marker hides with `probability` for a
/// Poisson(mean_frames) number of frames. Starts with all markers visible; on average
/// a share p m / (1 + p m) is hidden once it is stationary.
struct RandomOcclusion {
  double probability = 0.005;
  double mean_frames = 100;
};
MarkerSequence OccludeAtRandom(MarkerSequence sequence, const RandomOcclusion& occlusion,
                               std::uint64_t seed);

/// In every frame round(share * labels) markers are hidden; each for a Poisson(mean_frames) number
/// of frames, after which it comes back and a random visible one hides in its place. share in
/// [0, 1].
MarkerSequence OccludeShare(MarkerSequence sequence, double share, double mean_frames,
                            std::uint64_t seed);

}  // namespace mmm_converter
