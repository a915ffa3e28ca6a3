// SPDX-License-Identifier: MIT
#include "common/label/track/track_names.h"

#include <algorithm>

namespace mmm_converter {

TrackNames ResolveVotes(const TrackVotes& votes, const PointTracks& tracks, int num_markers,
                        double least_share) {
  struct Claim {
    int track, marker;
    double frames, share;
  };
  std::vector<Claim> claims;
  for (std::size_t t = 0; t < votes.size(); ++t) {
    const PointTrack& track = tracks.tracks[t];
    for (const auto& [marker, frames] : votes[t]) {
      const double share = frames / (track.end - track.begin);
      if (share > least_share) claims.push_back({static_cast<int>(t), marker, frames, share});
    }
  }
  std::stable_sort(claims.begin(), claims.end(),
                   [](const Claim& a, const Claim& b) { return a.frames > b.frames; });
  TrackNames names;
  names.markers.assign(votes.size(), -1);
  names.shares.assign(votes.size(), 0);
  std::vector<std::vector<char>> is_given(static_cast<std::size_t>(num_markers),
                                          std::vector<char>(tracks.frames.size(), 0));
  for (const Claim& claim : claims) {
    if (names.markers[claim.track] >= 0) continue;
    const PointTrack& track = tracks.tracks[claim.track];
    std::vector<char>& given = is_given[claim.marker];
    if (std::find(given.begin() + track.begin, given.begin() + track.end, 1) !=
        given.begin() + track.end) {
      continue;
    }
    std::fill(given.begin() + track.begin, given.begin() + track.end, 1);
    names.markers[claim.track] = claim.marker;
    names.shares[claim.track] = claim.share;
  }
  return names;
}

}  // namespace mmm_converter
