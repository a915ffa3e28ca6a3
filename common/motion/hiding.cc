// SPDX-License-Identifier: MIT
#include "common/motion/hiding.h"

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

void HideAtRandom(const Hiding& hiding, SeededRandom random, HiddenMarkers* hidden) {
  std::vector<int> frames_left(hidden->rows(), 0);
  for (int k = 0; k < hidden->cols(); ++k) {
    for (int i = 0; i < hidden->rows(); ++i) {
      if (frames_left[i] == 0 && random.Uniform() < hiding.amount) {
        frames_left[i] = random.Poisson(hiding.mean_frames);
      }
      if (frames_left[i] == 0) continue;
      (*hidden)(i, k) = true;
      --frames_left[i];
    }
  }
}

void HideShare(const Hiding& hiding, SeededRandom random, HiddenMarkers* hidden) {
  assert(hiding.amount <= 1);
  std::vector<int> visible(hidden->rows());
  std::iota(visible.begin(), visible.end(), 0);
  struct Hidden {
    int marker;
    int frames_left;
  };
  std::vector<Hidden> away(std::lround(hiding.amount * static_cast<double>(hidden->rows())));
  for (Hidden& one : away) {
    one.marker = TakeRandom(visible, random);
    // Part of the first absence is over already: the swaps are spread over time from the start.
    one.frames_left = static_cast<int>(random.Uniform() * random.Poisson(hiding.mean_frames));
  }
  for (int k = 0; k < hidden->cols(); ++k) {
    for (Hidden& one : away) {
      if (one.frames_left <= 0 && !visible.empty()) {
        const int returning = one.marker;
        one.marker = TakeRandom(visible, random);
        one.frames_left = random.Poisson(hiding.mean_frames);
        visible.push_back(returning);
      }
      --one.frames_left;
      (*hidden)(one.marker, k) = true;
    }
  }
}

}  // namespace

HiddenMarkers DrawHidden(const Hiding& hiding, int num_markers, int num_frames,
                         std::uint64_t seed) {
  HiddenMarkers hidden = HiddenMarkers::Constant(num_markers, num_frames, false);
  if (hiding.amount == 0) return hidden;
  const auto hide = hiding.model == HidingModel::kPaper ? HideAtRandom : HideShare;
  hide(hiding, SeededRandom(seed), &hidden);
  return hidden;
}

MarkerSequence WithoutHidden(MarkerSequence recording, const std::vector<LabelIx>& labels,
                             const HiddenMarkers& hidden) {
  for (int k = 0; k < recording.num_frames(); ++k) {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (!hidden(static_cast<int>(i), k)) continue;
      recording.frame(k).col(labels[i]).setConstant(kNaN);
    }
  }
  return recording;
}

}  // namespace mmm_converter
