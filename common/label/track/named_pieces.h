// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/label/track/label_options.h"
#include "common/label/track/labelling.h"
#include "common/label/track/track_names.h"

namespace mmm_converter {

/// What markers are to a recording and to a labelling.
struct MarkerColumns {
  std::vector<int> stored;   ///< by column: the marker that its own label names, -1: none
  std::vector<int> name_of;  ///< by marker: into Labelling::names
};

/// What each point is: what was found where that is sure enough, else what is stored where that has
/// no other place. By point, then by frame.
std::vector<NamedPiece> PiecesOf(const PointTracks& tracks, const TrackNames& found,
                                 const MarkerColumns& columns, const LabelOptions& options);

}  // namespace mmm_converter
