// SPDX-License-Identifier: MIT
#include "common/motion/occlusion.h"

#include <cassert>
#include <cmath>
#include <numeric>

#include "common/math/seeded_random.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

/// Removes and returns a random element.
int TakeRandom(std::vector<int>& elements, SeededRandom& random) {
  const int position = random.UniformIndex(static_cast<int>(elements.size()));
  const int element = elements[position];
  elements[position] = elements.back();
  elements.pop_back();
  return element;
}

}  // namespace

MarkerSequence OccludeAtRandom(MarkerSequence sequence, const RandomOcclusion& occlusion,
                               std::uint64_t seed) {
  SeededRandom random(seed);
  std::vector<int> frames_left(sequence.num_labels(), 0);
  for (int k = 0; k < sequence.num_frames(); ++k) {
    for (int i = 0; i < sequence.num_labels(); ++i) {
      if (frames_left[i] == 0 && random.Uniform() < occlusion.probability) {
        frames_left[i] = random.Poisson(occlusion.mean_frames);
      }
      if (frames_left[i] == 0) continue;
      sequence.frame(k).col(i).setConstant(kNaN);
      --frames_left[i];
    }
  }
  return sequence;
}

MarkerSequence OccludeShare(MarkerSequence sequence, double share, double mean_frames,
                            std::uint64_t seed) {
  assert(share >= 0 && share <= 1);
  SeededRandom random(seed);
  std::vector<int> visible(sequence.num_labels());
  std::iota(visible.begin(), visible.end(), 0);
  struct Hidden {
    int marker;
    int frames_left;
  };
  std::vector<Hidden> hidden(std::lround(share * sequence.num_labels()));
  for (Hidden& h : hidden) {
    h.marker = TakeRandom(visible, random);
    // Part of the first absence is over already: the swaps are spread over time from the start.
    h.frames_left = static_cast<int>(random.Uniform() * random.Poisson(mean_frames));
  }
  for (int k = 0; k < sequence.num_frames(); ++k) {
    for (Hidden& h : hidden) {
      if (h.frames_left <= 0 && !visible.empty()) {
        const int returning = h.marker;
        h.marker = TakeRandom(visible, random);
        h.frames_left = random.Poisson(mean_frames);
        visible.push_back(returning);
      }
      --h.frames_left;
      sequence.frame(k).col(h.marker).setConstant(kNaN);
    }
  }
  return sequence;
}

}  // namespace mmm_converter
