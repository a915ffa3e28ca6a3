// SPDX-License-Identifier: MIT
#include "common/label/track/named_pieces.h"

#include <algorithm>
#include <set>
#include <utility>

namespace mmm_converter {

namespace {

/// What was found where it is sure enough, else what is stored where that has no other place.
class NameOfPoints {
 public:
  NameOfPoints(const PointTracks& tracks, const TrackNames& found, const MarkerColumns& columns,
               const LabelOptions& options)
      : tracks_(tracks), found_(found), columns_(columns), options_(options) {
    for (std::size_t t = 0; t < tracks.tracks.size(); ++t) {
      for (int k = tracks.tracks[t].begin; k < tracks.tracks[t].end; ++k) {
        if (IsSure(static_cast<int>(t), k)) given_.insert({found.markers[t], k});
      }
    }
  }

  /// The marker of a track in a frame; -1: none.
  int operator()(int track, int k) const {
    if (IsSure(track, k)) return found_.markers[track];
    const int stored = StoredMarker(track, k);
    return stored >= 0 && !given_.contains({stored, k}) ? stored : -1;
  }

 private:
  int StoredMarker(int t, int k) const {
    const PointTrack& track = tracks_.tracks[t];
    return columns_.stored[tracks_.frames[k].columns[track.points[k - track.begin]]];
  }
  bool IsSure(int t, int k) const {
    if (found_.markers[t] < 0) return false;
    const int stored = StoredMarker(t, k);
    const bool is_change = stored >= 0 && stored != found_.markers[t];
    return found_.shares[t] >=
           (is_change ? options_.least_change_probability : options_.least_probability);
  }

  const PointTracks& tracks_;
  const TrackNames& found_;
  const MarkerColumns& columns_;
  const LabelOptions& options_;
  std::set<std::pair<int, int>> given_;  // marker, frame
};

}  // namespace

std::vector<NamedPiece> PiecesOf(const PointTracks& tracks, const TrackNames& found,
                                 const MarkerColumns& columns, const LabelOptions& options) {
  const NameOfPoints name_of(tracks, found, columns, options);
  std::vector<NamedPiece> pieces;
  for (std::size_t t = 0; t < tracks.tracks.size(); ++t) {
    const PointTrack& track = tracks.tracks[t];
    NamedPiece piece;
    for (int k = track.begin; k < track.end; ++k) {
      const LabelIx point(tracks.frames[k].columns[track.points[k - track.begin]]);
      const int marker = name_of(static_cast<int>(t), k);
      const int name = marker < 0 ? -1 : columns.name_of[marker];
      if (k > track.begin && piece.point == point && piece.name == name) {
        piece.end = k + 1;
        continue;
      }
      if (k > track.begin) pieces.push_back(piece);
      const bool is_found = marker >= 0 && marker == found.markers[t];
      piece = {point, k, k + 1, name, is_found ? found.shares[t] : 1 - found.shares[t]};
    }
    pieces.push_back(piece);
  }
  std::sort(pieces.begin(), pieces.end(), [](const NamedPiece& a, const NamedPiece& b) {
    return a.point != b.point ? a.point < b.point : a.begin < b.begin;
  });
  return pieces;
}

}  // namespace mmm_converter
