// SPDX-License-Identifier: MIT
#include "common/label/track/label_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "common/label/search/scene_start.h"
#include "common/label/track/labelled_person.h"
#include "common/label/track/named_pieces.h"
#include "common/label/track/point_tracks.h"
#include "common/label/tuning.h"
#include "common/support/error.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// A marker is counted over all: those of the first person, of the second, ..., of the objects.
class RecordingLabeller {
 public:
  RecordingLabeller(const LabelScene& scene, const MarkerSequence& recording,
                    const std::vector<LabelIx>& stored,
                    const std::function<bool(int, int)>& progress)
      : scene_(scene),
        recording_(recording),
        tracks_(FollowPoints(recording)),
        dt_(1 / recording.rate()),
        stored_(recording.num_labels(), -1),
        progress_(progress) {
    persons_ = MakePersons();
    for (const TrackingSetup& setup : scene.persons) {
      for (const MarkerAssignment& one : setup.assignments()) name_of_marker_.push_back(one.label);
    }
    for (const LabelObject& object : scene_.objects) {
      name_of_marker_.insert(name_of_marker_.end(), object.names.begin(), object.names.end());
    }
    for (std::size_t m = 0; m < name_of_marker_.size(); ++m) {
      const int name = name_of_marker_[m];
      if (name < static_cast<int>(stored.size()) && stored[name] >= 0) {
        stored_[stored[name]] = static_cast<int>(m);
      }
    }
  }

  MarkerColumns markers() const { return {stored_, name_of_marker_}; }
  const PointTracks& tracks() const { return tracks_; }

  TrackNames Run() {
    const int first_object = persons_.back().first_marker() + persons_.back().body().num_markers();
    const TrackNames of_objects =
        FindObjectTracks(scene_.objects, tracks_, first_object, [this](int k) { Show(k); });
    is_object_.clear();
    for (const int marker : of_objects.markers) is_object_.push_back(marker >= 0 ? 1 : 0);
    const std::vector<SceneStart> starts = FindStarts();
    TrackNames names = NamesFrom(starts.front());
    const std::size_t tried = std::min<std::size_t>(starts.size(), StartsTried());
    for (std::size_t i = 1; i < tried; ++i) {
      std::vector<LabelledPerson> others = MakePersons();
      others.swap(persons_);
      for (std::size_t p = 0; p < others.size(); ++p) {
        persons_[p].set_searches(others[p].searches());
      }
      TrackNames other = NamesFrom(starts[i]);
      if (VotesOf(other) > VotesOf(names)) {
        names = std::move(other);
      } else {
        persons_.swap(others);
      }
    }
    names = ForwardAndBackward(names);
    for (std::size_t t = 0; t < is_object_.size(); ++t) {
      if (is_object_[t] == 0) continue;
      names.markers[t] = of_objects.markers[t];
      names.shares[t] = of_objects.shares[t];
    }
    return names;
  }

 private:
  std::vector<LabelledPerson> MakePersons() const {
    std::vector<LabelledPerson> persons;
    int marker = 0;
    for (const TrackingSetup& setup : scene_.persons) {
      persons.emplace_back(setup, marker, tracks_, dt_);
      marker += persons.back().body().num_markers();
    }
    return persons;
  }

  std::vector<SceneStart> FindStarts() {
    std::vector<Matrix3Xd> frames;
    frames.reserve(tracks_.frames.size());
    for (const FramePoints& points : tracks_.frames) {
      std::vector<int> left;
      for (std::size_t p = 0; p < points.tracks.size(); ++p) {
        if (is_object_[points.tracks[p]] == 0) left.push_back(static_cast<int>(p));
      }
      frames.emplace_back(points.p_WP(Eigen::all, left));
    }
    std::vector<const LabelBody*> bodies;
    bodies.reserve(persons_.size());
    for (const LabelledPerson& person : persons_) bodies.push_back(&person.body());
    std::vector<SceneStart> starts = FindScene(bodies, frames, [this] { Show(0); });
    const SceneStart& best = starts.front();
    if (bodies.size() == 1 && !has_labels()) {
      CheckSize(*bodies.front(), frames[best.frame], best.matches.front());
    }
    return starts;
  }

  bool has_labels() const {
    return std::any_of(stored_.begin(), stored_.end(), [](int marker) { return marker >= 0; });
  }

  /// Where somebody is not calibrated, what is wrong at the start is learnt by the calibration:
  /// more than one is tried.
  int StartsTried() const {
    const bool is_known =
        std::all_of(persons_.begin(), persons_.end(),
                    [](const LabelledPerson& person) { return person.was_calibrated(); });
    return is_known || has_labels() || recording_.num_frames() > RecordingTuning::kMostFramesTried
               ? 1
               : RecordingTuning::kStartsTried;
  }

  /// With the persons as they are there.
  TrackNames NamesFrom(const SceneStart& start) {
    for (std::size_t i = 0; i < persons_.size(); ++i) persons_[i].Start(start.matches[i]);
    for (int k = start.frame; k >= 0; --k) Track(k, {}, nullptr);
    Reverse();
    TrackNames names = ForwardAndBackward({});
    return Calibrate(names) ? ForwardAndBackward(names) : names;
  }

  /// That the names got [frames].
  double VotesOf(const TrackNames& names) const {
    double votes = 0;
    for (std::size_t t = 0; t < tracks_.tracks.size(); ++t) {
      const PointTrack& track = tracks_.tracks[t];
      if (names.markers[t] >= 0) votes += names.shares[t] * (track.end - track.begin);
    }
    return votes;
  }

  void Reverse() {
    for (LabelledPerson& person : persons_) person.tracker().Reverse();
  }

  std::vector<LabelBelief> Beliefs() const {
    std::vector<LabelBelief> beliefs;
    beliefs.reserve(persons_.size());
    for (const LabelledPerson& person : persons_) beliefs.push_back(person.tracker().belief());
    return beliefs;
  }

  void Restore(const std::vector<LabelBelief>& beliefs) {
    for (std::size_t i = 0; i < persons_.size(); ++i) persons_[i].tracker().Restore(beliefs[i]);
  }

  std::size_t PersonOf(int marker) const {
    std::size_t i = persons_.size() - 1;
    while (persons_[i].first_marker() > marker) --i;
    return i;
  }

  /// Who is likeliest to have a point there.
  std::size_t LikeliestPerson(const Vector3d& p_WP) const {
    std::size_t likeliest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < persons_.size(); ++i) {
      const LabelledPerson& person = persons_[i];
      const Eigen::ArrayXd d2 = (person.places.colwise() - p_WP).colwise().squaredNorm();
      const double cost =
          (d2 / person.variances.array() + 3 * person.variances.array().log()).minCoeff();
      if (cost >= least) continue;
      least = cost;
      likeliest = i;
    }
    return likeliest;
  }

  /// Offers each point that is no object's to one person: who surely had it before, or else the
  /// likeliest.
  void Offer(int k, const TrackNames& before) {
    const FramePoints& points = tracks_.frames[k];
    const bool is_first_time = before.markers.empty();
    for (LabelledPerson& person : persons_) {
      if (persons_.size() > 1)
        person.tracker().PredictPlaces(dt_, &person.places, &person.variances);
      person.offered.clear();
      person.hints.markers.clear();
      person.hints.worth.clear();
    }
    for (std::size_t p = 0; p < points.tracks.size(); ++p) {
      const int track = points.tracks[p];
      if (is_object_[track] != 0) continue;
      const int marker = is_first_time ? stored_[points.columns[p]] : before.markers[track];
      const double share = is_first_time ? 1 : before.shares[track];
      std::size_t owner = 0;
      if (persons_.size() > 1) {
        const bool is_known = !is_first_time && marker >= 0 && share >= RecordingTuning::kSureName;
        owner = is_known ? PersonOf(marker)
                         : LikeliestPerson(points.p_WP.col(static_cast<Eigen::Index>(p)));
      }
      LabelledPerson& person = persons_[owner];
      const int own = marker - person.first_marker();
      person.offered.push_back(static_cast<int>(p));
      person.hints.markers.push_back(own >= 0 && own < person.body().num_markers() ? own : -1);
      person.hints.worth.push_back(RecordingTuning::kHint * share);
    }
    for (LabelledPerson& person : persons_) person.points = points.p_WP(Eigen::all, person.offered);
  }

  /// votes: null, or what the frame adds to.
  void Track(int k, const TrackNames& before, TrackVotes* votes) {
    Offer(k, before);
    for (LabelledPerson& person : persons_) {
      Vote(k, person, person.Follow(), RecordingTuning::kVote, votes);
    }
  }

  void Vote(int k, const LabelledPerson& person, const std::vector<int>& point_of_marker,
            double weight, TrackVotes* votes) const {
    for (int m = 0; m < person.body().num_markers() && votes != nullptr; ++m) {
      if (point_of_marker[m] < 0) continue;
      const int track = tracks_.frames[k].tracks[person.offered[point_of_marker[m]]];
      (*votes)[track][person.first_marker() + m] += weight;
    }
  }

  /// Forward over the recording, and back again; on the way back each frame is judged by what came
  /// before and after it. Predictions of the way forward are kept for a part at a time.
  TrackNames ForwardAndBackward(const TrackNames& before) {
    TrackVotes votes(tracks_.tracks.size());
    const int frames = static_cast<int>(tracks_.frames.size());
    std::vector<std::vector<LabelBelief>> starts;  // of the parts
    for (int k = 0; k < frames; ++k) {
      if (k % RecordingTuning::kPart == 0) starts.push_back(Beliefs());
      Track(k, before, &votes);
      Show(k);
    }
    Reverse();
    std::vector<LabelBelief> backward = Beliefs();
    std::vector<std::vector<LabelTracker::Prediction>> predictions;  // by frame, by person
    for (int part = static_cast<int>(starts.size()) - 1; part >= 0; --part) {
      const int begin = part * RecordingTuning::kPart;
      const int end = std::min(begin + RecordingTuning::kPart, frames);
      predictions.clear();
      Restore(starts[part]);
      for (int k = begin; k < end; ++k) {
        Track(k, before, nullptr);
        predictions.emplace_back();
        for (const LabelledPerson& person : persons_) {
          predictions.back().push_back(person.tracker().prediction());
        }
      }
      Restore(backward);
      for (int k = end - 1; k >= begin; --k) {
        Track(k, before, &votes);
        for (std::size_t i = 0; i < persons_.size(); ++i) {
          LabelledPerson& person = persons_[i];
          const std::vector<int>& between = person.tracker().AssignBetween(
              person.points, predictions[k - begin][i], person.hints);
          Vote(k, person, between, 2 * RecordingTuning::kVote, &votes);
          person.KeepFrame(k, between);
        }
      }
      backward = Beliefs();
    }
    Reverse();
    TrackNames names = ResolveVotes(votes, tracks_, static_cast<int>(name_of_marker_.size()),
                                    RecordingTuning::kLeastShare);
    for (LabelledPerson& person : persons_) person.Improve(&names);
    return names;
  }

  /// True: someone was.
  bool Calibrate(const TrackNames& names) {
    bool is_anyone = false;
    for (LabelledPerson& person : persons_) {
      if (person.Calibrate(names, [this] { Show(static_cast<int>(tracks_.frames.size())); })) {
        is_anyone = true;
      }
    }
    return is_anyone;
  }

  void Show(int k) {
    if (progress_ && !progress_(k, static_cast<int>(tracks_.frames.size()))) {
      throw Error("labelling was cancelled");
    }
  }

  const LabelScene& scene_;
  std::vector<LabelledPerson> persons_;
  std::vector<int> name_of_marker_;
  const MarkerSequence& recording_;
  PointTracks tracks_;
  std::vector<char> is_object_;  // by track
  double dt_;
  std::vector<int> stored_;  // marker by column
  const std::function<bool(int, int)>& progress_;
};

}  // namespace

Labelling LabelRecording(const LabelScene& scene, const std::vector<std::string>& names,
                         const MarkerSequence& recording, const LabelOptions& options,
                         const std::function<bool(int, int)>& progress) {
  for (std::size_t i = 0; i < scene.persons.size(); ++i) {
    const std::size_t markers = scene.persons[i].assignments().size();
    if (markers >= BodyLimits::kFewestMarkers) continue;
    throw Error(
        fmt::format("{} with {} markers can't be found among points; at least {} are needed",
                    i == 0 ? "a body" : fmt::format("the body of person {}", i + 1), markers,
                    BodyLimits::kFewestMarkers));
  }
  for (int k = 0; k < recording.num_frames(); ++k) {
    const auto seen = recording.frame(k).row(0).array().isFinite().count();
    if (seen > BodyLimits::kMostPoints) {
      throw Error(fmt::format("frame {} has {} points; at most {} can be labelled", k, seen,
                              BodyLimits::kMostPoints));
    }
    if (seen > ObjectTuning::kMostPoints && !scene.objects.empty()) {
      throw Error(fmt::format("frame {} has {} points; objects can be found among {} at most", k,
                              seen, ObjectTuning::kMostPoints));
    }
  }
  RecordingLabeller labeller(scene, recording, options.stored, progress);
  const auto found = labeller.Run();
  Labelling labelling;
  labelling.names = names;
  labelling.pieces = PiecesOf(labeller.tracks(), found, labeller.markers(), options);
  return labelling;
}

}  // namespace mmm_converter
