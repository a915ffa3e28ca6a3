// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "common/label/track/point_tracks.h"

namespace mmm_converter {

/// How often each track was taken for a marker: by track, weights of the frames by marker.
using TrackVotes = std::vector<std::map<int, double>>;

/// The marker of each track, -1: none, and the share of the votes that it has.
struct TrackNames {
  std::vector<int> markers;
  std::vector<double> shares;
};

/// The tracks with most votes first; a name is not given twice in a frame, and not by a share of
/// `least_share` or less.
TrackNames ResolveVotes(const TrackVotes& votes, const PointTracks& tracks, int num_markers,
                        double least_share);

}  // namespace mmm_converter
