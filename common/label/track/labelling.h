// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Frames [begin, end) in which one point of a recording follows one thing, and what that thing is.
struct NamedPiece {
  LabelIx point;           ///< column of the recording
  int begin = 0, end = 0;  ///< frames
  int name = -1;           ///< into Labelling::names; -1: nobody's, a ghost or not told
  double probability = 0;  ///< of the name; of a piece without: that it has none
};

/// Which point of a recording is which marker.
struct Labelling {
  std::vector<std::string> names;
  /// By point, then by frame; the pieces of a point do not overlap and cover the frames that it is
  /// seen in. No two pieces of one name overlap.
  std::vector<NamedPiece> pieces;
};

/// Those that no point has in any frame.
std::vector<std::string> NamesNotFound(const Labelling& labelling);

}  // namespace mmm_converter
