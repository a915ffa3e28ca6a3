// SPDX-License-Identifier: MIT
#include "common/label/label_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include "common/calibrate/calibration.h"
#include "common/label/label_body.h"
#include "common/label/label_tracker.h"
#include "common/label/point_tracks.h"
#include "common/support/error.h"

namespace mmm_converter {

namespace {

constexpr int kFewestNames = 10;
constexpr int kMostPoints = 1000;  // of a frame: time grows with their square
constexpr int kFirstFrames = 8;    // that the body is looked for in
constexpr double kLeastShare = 0.25;
constexpr int kTimes = 2;
constexpr double kSure = 0.7;
constexpr int kPart = 256;   // frames whose predictions are kept
constexpr double kHint = 6;  // cost that a track's name is worth

/// How often the passes took a track for a marker.
using Votes = std::vector<std::map<int, double>>;  // by track: marker, frames

bool IsUncalibrated(const TrackingSetup& setup) {
  return std::none_of(setup.assignments().begin(), setup.assignments().end(),
                      [&setup](const MarkerAssignment& assignment) {
                        return setup.model->markers()[assignment.marker].deviation.has_value();
                      });
}

class RecordingLabeller {
 public:
  RecordingLabeller(const TrackingSetup& setup, const MarkerSequence& recording,
                    const std::vector<LabelIx>& stored,
                    const std::function<bool(int, int)>& progress)
      : setup_(setup),
        body_(std::make_unique<LabelBody>(setup)),
        recording_(recording),
        tracks_(FollowPoints(recording)),
        dt_(1 / recording.rate()),
        stored_(recording.num_labels(), -1),
        progress_(progress) {
    for (std::size_t m = 0; m < setup.assignments().size(); ++m) {
      const int name = setup.assignments()[m].label;
      if (name < static_cast<int>(stored.size()) && stored[name] >= 0) {
        stored_[stored[name]] = static_cast<int>(m);
      }
    }
  }

  /// The marker that the recording's own label of a column names, -1: none.
  int stored(int column) const { return stored_[column]; }

  const PointTracks& tracks() const { return tracks_; }

  /// The marker of each track, -1: none, and the share of the votes that it has.
  struct Names {
    std::vector<int> markers;
    std::vector<double> shares;
  };
  Names Run() {
    Names names;
    BodySearch search(*body_);
    const auto [first, match] = FindFirst(&search);
    auto tracker = std::make_unique<LabelTracker>(*body_);
    tracker->Start(match);
    for (int k = first; k >= 0; --k) Track(k, nullptr, tracker.get());
    tracker->Reverse();
    for (int time = 0; time < kTimes; ++time) {
      names = ForwardAndBackward(names, tracker.get());
      if (time > 0 || !Calibrate(names)) continue;
      BodyMatch posture;
      posture.posture = tracker->belief().posture;
      tracker = std::make_unique<LabelTracker>(*body_);
      tracker->Start(posture);
      names = ForwardAndBackward(names, tracker.get());
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
    if (best.first < 0 || 2 * best.second.matched < body_->num_markers()) {
      throw Error(fmt::format(
          "no frame shows a person: of {} markers at most {} fit any posture of this body; is it "
          "the right person, height and set of markers?",
          body_->num_markers(), best.first < 0 ? 0 : best.second.matched));
    }
    return best;
  }

  const std::vector<int>& Track(int k, const Names* before, LabelTracker* tracker) {
    return tracker->Track(tracks_.frames[k].p_WP, dt_, Hint(k, before));
  }

  const LabelTracker::Hints* Hint(int k, const Names* before) {
    const FramePoints& points = tracks_.frames[k];
    if (before == nullptr || before->markers.empty()) return StoredHint(points);
    hints_.markers.resize(points.tracks.size());
    hints_.worth.resize(points.tracks.size());
    for (std::size_t p = 0; p < points.tracks.size(); ++p) {
      hints_.markers[p] = before->markers[points.tracks[p]];
      hints_.worth[p] = kHint * before->shares[points.tracks[p]];
    }
    return &hints_;
  }

  const LabelTracker::Hints* StoredHint(const FramePoints& points) {
    hints_.markers.resize(points.columns.size());
    for (std::size_t p = 0; p < points.columns.size(); ++p) {
      hints_.markers[p] = stored_[points.columns[p]];
    }
    hints_.worth.assign(points.columns.size(), kHint);
    return &hints_;
  }

  void Vote(int k, const std::vector<int>& point_of_marker, double weight, Votes* votes) const {
    for (int m = 0; m < body_->num_markers(); ++m) {
      const int point = point_of_marker[m];
      if (point >= 0) (*votes)[tracks_.frames[k].tracks[point]][m] += weight;
    }
  }

  /// Forward over the recording, and back again; on the way back each frame is judged by what came
  /// before and after it. Predictions of the way forward are kept for a part at a time.
  Names ForwardAndBackward(const Names& before, LabelTracker* tracker) {
    Votes votes(tracks_.tracks.size());
    const int frames = static_cast<int>(tracks_.frames.size());
    std::vector<LabelBelief> starts;  // of the parts
    for (int k = 0; k < frames; ++k) {
      if (k % kPart == 0) starts.push_back(tracker->belief());
      Vote(k, Track(k, &before, tracker), 0.25, &votes);
      Show(k);
    }
    tracker->Reverse();
    LabelBelief backward = tracker->belief();
    std::vector<LabelTracker::Prediction> predictions;
    for (int part = static_cast<int>(starts.size()) - 1; part >= 0; --part) {
      const int begin = part * kPart;
      const int end = std::min(begin + kPart, frames);
      predictions.clear();
      tracker->Restore(starts[part]);
      for (int k = begin; k < end; ++k) {
        Track(k, &before, tracker);
        predictions.push_back(tracker->prediction());
      }
      tracker->Restore(backward);
      for (int k = end - 1; k >= begin; --k) {
        Vote(k, Track(k, &before, tracker), 0.25, &votes);
        const std::vector<int>& between =
            tracker->Between(tracks_.frames[k].p_WP, predictions[k - begin], Hint(k, &before));
        Vote(k, between, 0.5, &votes);
      }
      backward = tracker->belief();
    }
    tracker->Reverse();
    return Resolve(votes);
  }

  /// Whoever was only scaled by height is calibrated on what has surely got its name.
  bool Calibrate(const Names& names) {
    if (!IsUncalibrated(setup_)) return false;
    std::vector<std::string> labels;
    std::vector<MarkerAssignment> assignments = setup_.assignments();
    for (std::size_t m = 0; m < assignments.size(); ++m) {
      labels.push_back(std::to_string(m));
      assignments[m].label = LabelIx(static_cast<int>(m));
    }
    MarkerSequence named(labels, recording_.num_frames(), recording_.rate(),
                         recording_.first_time());
    for (std::size_t t = 0; t < tracks_.tracks.size(); ++t) {
      const PointTrack& track = tracks_.tracks[t];
      if (names.markers[t] < 0 || names.shares[t] < kSure) continue;
      for (int k = track.begin; k < track.end; ++k) {
        named.frame(k).col(names.markers[t]) =
            tracks_.frames[k].p_WP.col(track.points[k - track.begin]);
      }
    }
    try {
      const CalibrationResult result =
          CalibrateSubject(*setup_.model, setup_.joints, {{"", &named, assignments}}, {});
      setup_.model =
          std::make_shared<const KinematicModel>(FitToSubject(*setup_.model, result.subject));
      body_ = std::make_unique<LabelBody>(setup_);
    } catch (const Error&) {
      return false;  // too short or too still: as before
    }
    return true;
  }

  void Show(int k) {
    if (progress_ && !progress_(k, static_cast<int>(tracks_.frames.size()))) {
      throw Error("labelling was cancelled");
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
    std::vector<std::vector<char>> is_given(body_->num_markers(),
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

  TrackingSetup setup_;
  std::unique_ptr<LabelBody> body_;
  const MarkerSequence& recording_;
  PointTracks tracks_;
  double dt_;
  std::vector<int> stored_;  // marker by column
  const std::function<bool(int, int)>& progress_;
  LabelTracker::Hints hints_;
};

/// What was found where it is sure enough, else what is stored where that has no other place.
class NameOfPoints {
 public:
  NameOfPoints(const RecordingLabeller& labeller, const RecordingLabeller::Names& found,
               const LabelOptions& options)
      : labeller_(labeller), found_(found), options_(options) {
    const PointTracks& tracks = labeller.tracks();
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
    const PointTrack& track = labeller_.tracks().tracks[t];
    return labeller_.stored(labeller_.tracks().frames[k].columns[track.points[k - track.begin]]);
  }
  bool IsSure(int t, int k) const {
    if (found_.markers[t] < 0) return false;
    const int stored = StoredMarker(t, k);
    const bool is_change = stored >= 0 && stored != found_.markers[t];
    return found_.shares[t] >=
           (is_change ? options_.least_change_probability : options_.least_probability);
  }

  const RecordingLabeller& labeller_;
  const RecordingLabeller::Names& found_;
  const LabelOptions& options_;
  std::set<std::pair<int, int>> given_;  // marker, frame
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
  for (int k = 0; k < recording.num_frames(); ++k) {
    const auto seen = recording.frame(k).row(0).array().isFinite().count();
    if (seen > kMostPoints) {
      throw Error(
          fmt::format("frame {} has {} points; at most {} can be labelled", k, seen, kMostPoints));
    }
  }
  RecordingLabeller labeller(setup, recording, options.stored, progress);
  const auto found = labeller.Run();
  const PointTracks& tracks = labeller.tracks();
  const NameOfPoints name_of(labeller, found, options);
  Labelling labelling;
  labelling.names = names;
  for (std::size_t t = 0; t < tracks.tracks.size(); ++t) {
    const PointTrack& track = tracks.tracks[t];
    NamedPiece piece;
    for (int k = track.begin; k < track.end; ++k) {
      const LabelIx point(tracks.frames[k].columns[track.points[k - track.begin]]);
      const int marker = name_of(static_cast<int>(t), k);
      const int name = marker < 0 ? -1 : static_cast<int>(setup.assignments()[marker].label);
      if (k > track.begin && piece.point == point && piece.name == name) {
        piece.end = k + 1;
        continue;
      }
      if (k > track.begin) labelling.pieces.push_back(piece);
      const bool is_found = marker >= 0 && marker == found.markers[t];
      piece = {point, k, k + 1, name, is_found ? found.shares[t] : 1 - found.shares[t]};
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
