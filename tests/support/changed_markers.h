// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/motion/marker_sequence.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter::testing {

/// @throws Error for a label that the recording does not have.
inline int IndexOf(const MarkerSequence& sequence, const std::string& label) {
  const int index = sequence.FindLabel(label);
  if (index < 0) throw Error("marker '" + label + "' is not in the recording");
  return index;
}

/// Hides `labels` in frames [begin, end).
inline MarkerSequence HideMarkers(MarkerSequence sequence, const std::vector<std::string>& labels,
                                  int begin, int end) {
  for (const std::string& label : labels) {
    const int index = IndexOf(sequence, label);
    for (int k = begin; k < end; ++k) sequence.frame(k).col(index).setConstant(kNaN);
  }
  return sequence;
}

/// Hides all markers in frames [begin, end).
inline MarkerSequence HideAllMarkers(MarkerSequence sequence, int begin, int end) {
  for (int k = begin; k < end; ++k) sequence.frame(k).setConstant(kNaN);
  return sequence;
}

/// Each of two markers bears the other's label in frames [begin, end).
inline MarkerSequence SwapMarkers(MarkerSequence sequence, const std::string& a,
                                  const std::string& b, int begin, int end) {
  const int index_a = IndexOf(sequence, a);
  const int index_b = IndexOf(sequence, b);
  for (int k = begin; k < end; ++k) {
    auto frame = sequence.frame(k);
    frame.col(index_a).swap(frame.col(index_b));
  }
  return sequence;
}

}  // namespace mmm_converter::testing
