// SPDX-License-Identifier: MIT
#include "common/label/label_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "common/label/label_body.h"
#include "common/label/label_tracker.h"
#include "common/label/point_tracks.h"
#include "common/support/error.h"

namespace mmm_converter {

namespace {

constexpr int kFewestNames = 10;
constexpr int kFirstFrames = 8;  // that the body is looked for in
constexpr double kLeastShare = 0.25;
constexpr double kHint = 6;  // cost that a track's name is worth

/// How often the passes took a track for a marker.
using Votes = std::vector<std::map<int, double>>;  // by track: marker, frames

class RecordingLabeller {
 public:
  RecordingLabeller(const TrackingSetup& setup, const MarkerSequence& recording,
                    const std::function<bool(int, int)>& progress)
      : body_(setup),
        tracks_(FollowPoints(recording)),
        dt_(1 / recording.rate()),
        progress_(progress) {}

  const PointTracks& tracks() const { return tracks_; }

  /// The marker of each track, -1: none, and the share of the votes that it has.
  struct Names {
    std::vector<int> markers;
    std::vector<double> shares;
  };
  Names Run() {
    Names names;
    BodySearch search(body_);
    const auto [first, match] = FindFirst(&search);
    LabelTracker tracker(body_);
    tracker.Start(match);
    Votes votes(tracks_.tracks.size());
    const int frames = static_cast<int>(tracks_.frames.size());
    Pass(first, frames, 1, nullptr, &tracker, nullptr);
    for (int round = 0; round < 2; ++round) {
      const Names hints = std::move(names);
      votes.assign(tracks_.tracks.size(), {});
      Pass(frames - 1, -1, -1, &hints, &tracker, &votes);
      Pass(0, frames, 1, &hints, &tracker, &votes);
      names = Resolve(votes);
    }
    return names;
  }

 private:
  std::pair<int, BodyMatch> FindFirst(BodySearch* search) {
    std::vector<int> order(tracks_.frames.size());
    std::iota(order.begin(), order.end(), 0);
    const int most = static_cast<int>(order.size());
    std::stable_sort(order.begin(), order.end(), [this](int a, int b) {
      return tracks_.frames[a].columns.size() > tracks_.frames[b].columns.size();
    });
    std::pair<int, BodyMatch> best = {-1, {}};
    // Of the fullest third, spread over the recording.
    const int candidates = std::max(most / 3, std::min(most, kFirstFrames));
    const int count = std::min(candidates, kFirstFrames);
    for (int i = 0; i < count; ++i) {
      const int k = order[static_cast<std::size_t>(i) * candidates / count];
      if (tracks_.frames[k].columns.size() < kFewestNames) continue;
      BodyMatch match = search->Find(tracks_.frames[k].p_WP);
      if (best.first < 0 || match.cost < best.second.cost) best = {k, std::move(match)};
    }
    if (best.first < 0 || 2 * best.second.matched < body_.num_markers()) {
      throw Error(fmt::format(
          "no frame shows a person: of {} markers at most {} fit any posture of this body; is it "
          "the right person, height and set of markers?",
          body_.num_markers(), best.first < 0 ? 0 : best.second.matched));
    }
    return best;
  }

  void Pass(int begin, int end, int step, const Names* before, LabelTracker* tracker,
            Votes* votes) {
    LabelTracker::Hints hints;
    for (int k = begin; k != end; k += step) {
      const FramePoints& points = tracks_.frames[k];
      hints.markers.assign(points.tracks.size(), -1);
      hints.worth.assign(points.tracks.size(), 0);
      for (std::size_t p = 0; before != nullptr && p < points.tracks.size(); ++p) {
        if (before->markers.empty()) break;
        hints.markers[p] = before->markers[points.tracks[p]];
        hints.worth[p] = kHint * before->shares[points.tracks[p]];
      }
      const std::vector<int>& point_of_marker = tracker->Track(points.p_WP, dt_, &hints);
      if (votes == nullptr) continue;
      for (int m = 0; m < body_.num_markers(); ++m) {
        if (point_of_marker[m] >= 0) (*votes)[points.tracks[point_of_marker[m]]][m] += 0.5;
      }
      ++done_;
      const int all = 2 * static_cast<int>(tracks_.frames.size());
      if (progress_ && !progress_(done_, all)) throw Error("labelling was cancelled");
    }
  }

  /// The surest first; a name is not given twice in a frame.
  Names Resolve(const Votes& votes) const {
    struct Claim {
      int track, marker;
      double frames, share;
    };
    std::vector<Claim> claims;
    for (std::size_t t = 0; t < votes.size(); ++t) {
      const PointTrack& track = tracks_.tracks[t];
      for (const auto& [marker, frames] : votes[t]) {
        const double share = frames / (track.end - track.begin);
        if (share > kLeastShare) claims.push_back({static_cast<int>(t), marker, frames, share});
      }
    }
    std::stable_sort(claims.begin(), claims.end(),
                     [](const Claim& a, const Claim& b) { return a.frames > b.frames; });
    Names names;
    names.markers.assign(votes.size(), -1);
    names.shares.assign(votes.size(), 0);
    std::vector<std::vector<char>> is_given(body_.num_markers(),
                                            std::vector<char>(tracks_.frames.size(), 0));
    for (const Claim& claim : claims) {
      if (names.markers[claim.track] >= 0) continue;
      const PointTrack& track = tracks_.tracks[claim.track];
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

  LabelBody body_;
  PointTracks tracks_;
  double dt_;
  const std::function<bool(int, int)>& progress_;
  int done_ = 0;
};

}  // namespace

Labelling LabelRecording(const TrackingSetup& setup, const std::vector<std::string>& names,
                         const MarkerSequence& recording, const LabelOptions& options,
                         const std::function<bool(int, int)>& progress) {
  if (setup.assignments().size() < kFewestNames) {
    throw Error(
        fmt::format("a body with {} markers can't be found among points; at least {} are "
                    "needed",
                    setup.assignments().size(), kFewestNames));
  }
  RecordingLabeller labeller(setup, recording, progress);
  const auto found = labeller.Run();
  Labelling labelling;
  labelling.names = names;
  const PointTracks& tracks = labeller.tracks();
  for (std::size_t t = 0; t < tracks.tracks.size(); ++t) {
    const PointTrack& track = tracks.tracks[t];
    const bool is_named = found.markers[t] >= 0 && found.shares[t] >= options.least_probability;
    NamedPiece piece;
    piece.name = is_named ? static_cast<int>(setup.assignments()[found.markers[t]].label) : -1;
    piece.probability = is_named ? found.shares[t] : 1 - found.shares[t];
    for (int k = track.begin; k < track.end; ++k) {
      const LabelIx point(tracks.frames[k].columns[track.points[k - track.begin]]);
      if (piece.end == k && piece.point == point && k > track.begin) {
        piece.end = k + 1;
        continue;
      }
      if (k > track.begin) labelling.pieces.push_back(piece);
      piece.point = point;
      piece.begin = k;
      piece.end = k + 1;
    }
    labelling.pieces.push_back(piece);
  }
  std::sort(labelling.pieces.begin(), labelling.pieces.end(),
            [](const NamedPiece& a, const NamedPiece& b) {
              return a.point != b.point ? a.point < b.point : a.begin < b.begin;
            });
  return labelling;
}

}  // namespace mmm_converter
