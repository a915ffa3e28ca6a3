// SPDX-License-Identifier: MIT
#include "common/label/label_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "common/calibrate/calibration.h"
#include "common/label/label_body.h"
#include "common/label/label_tracker.h"
#include "common/label/named_pieces.h"
#include "common/label/point_tracks.h"
#include "common/label/rigid_finder.h"
#include "common/label/scene_start.h"
#include "common/label/worn_elsewhere.h"
#include "common/support/error.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kFewestNames = 10;
constexpr int kMostPoints = 1000;  // of a frame: time grows with their square
constexpr double kLeastShare = 0.25;
constexpr int kTimes = 2;
constexpr double kSure = 0.7;
constexpr int kPart = 256;       // frames whose predictions are kept
constexpr double kHint = 6;      // cost that a track's name is worth
constexpr double kKnown = 0.02;  // [m] of a link that says where a marker is worn

bool IsUncalibrated(const TrackingSetup& setup) {
  return std::none_of(setup.assignments().begin(), setup.assignments().end(),
                      [&setup](const MarkerAssignment& assignment) {
                        return setup.model->markers()[assignment.marker].deviation.has_value();
                      });
}

/// A marker is counted over all: those of the first person, of the second, ..., of the objects.
class RecordingLabeller {
 public:
  RecordingLabeller(const LabelScene& scene, const MarkerSequence& recording,
                    const std::vector<LabelIx>& stored,
                    const std::function<bool(int, int)>& progress)
      : objects_(scene.objects),
        recording_(recording),
        tracks_(FollowPoints(recording)),
        dt_(1 / recording.rate()),
        stored_(recording.num_labels(), -1),
        progress_(progress) {
    for (const TrackingSetup& setup : scene.persons) {
      Person& person = persons_.emplace_back();
      person.setup = setup;
      person.body = std::make_unique<LabelBody>(setup);
      person.first_marker = static_cast<int>(name_of_marker_.size());
      for (const MarkerAssignment& one : setup.assignments()) name_of_marker_.push_back(one.label);
    }
    for (const LabelObject& object : objects_) {
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
    const int first_object = persons_.back().first_marker + persons_.back().body->num_markers();
    const TrackNames of_objects =
        FindObjectTracks(objects_, tracks_, first_object, [this](int k) { Show(k); });
    is_object_.clear();
    for (const int marker : of_objects.markers) is_object_.push_back(marker >= 0 ? 1 : 0);
    TrackNames names;
    const int first = Start();
    for (int k = first; k >= 0; --k) Track(k, {}, nullptr);
    Reverse();
    for (int time = 0; time < kTimes; ++time) {
      names = ForwardAndBackward(names);
      if (time > 0) continue;
      NameElsewhere(&names);
      if (!Calibrate(names)) continue;
      for (Person& person : persons_) {
        BodyMatch posture;
        posture.posture = person.tracker->belief().posture;
        person.tracker = std::make_unique<LabelTracker>(*person.body);
        person.tracker->Start(posture);
      }
      names = ForwardAndBackward(names);
    }
    for (std::size_t t = 0; t < is_object_.size(); ++t) {
      if (is_object_[t] == 0) continue;
      names.markers[t] = of_objects.markers[t];
      names.shares[t] = of_objects.shares[t];
    }
    return names;
  }

 private:
  struct Person {
    TrackingSetup setup;
    std::unique_ptr<LabelBody> body;
    std::unique_ptr<LabelTracker> tracker;
    int first_marker = 0;
    // Of this frame:
    std::vector<int> offered;  ///< points
    Matrix3Xd points;          ///< these
    LabelTracker::Hints hints;
    Matrix3Xd places;  ///< foreseen, of the markers
    VectorXd variances;
  };

  /// Takes the persons up in the frame that is returned.
  int Start() {
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
    for (const Person& person : persons_) bodies.push_back(person.body.get());
    const SceneStart start = FindScene(bodies, frames);
    for (std::size_t i = 0; i < persons_.size(); ++i) {
      persons_[i].tracker = std::make_unique<LabelTracker>(*persons_[i].body);
      persons_[i].tracker->Start(start.matches[i]);
    }
    return start.frame;
  }

  void Reverse() {
    for (Person& person : persons_) person.tracker->Reverse();
  }

  std::vector<LabelBelief> Beliefs() const {
    std::vector<LabelBelief> beliefs;
    beliefs.reserve(persons_.size());
    for (const Person& person : persons_) beliefs.push_back(person.tracker->belief());
    return beliefs;
  }

  void Restore(const std::vector<LabelBelief>& beliefs) {
    for (std::size_t i = 0; i < persons_.size(); ++i) persons_[i].tracker->Restore(beliefs[i]);
  }

  std::size_t PersonOf(int marker) const {
    std::size_t i = persons_.size() - 1;
    while (persons_[i].first_marker > marker) --i;
    return i;
  }

  /// Who is likeliest to have a point there.
  std::size_t LikeliestPerson(const Vector3d& p_WP) const {
    std::size_t likeliest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < persons_.size(); ++i) {
      const Person& person = persons_[i];
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
    for (Person& person : persons_) {
      if (persons_.size() > 1) person.tracker->Foresee(dt_, &person.places, &person.variances);
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
        const bool is_known = !is_first_time && marker >= 0 && share >= kSure;
        owner = is_known ? PersonOf(marker)
                         : LikeliestPerson(points.p_WP.col(static_cast<Eigen::Index>(p)));
      }
      Person& person = persons_[owner];
      const int own = marker - person.first_marker;
      person.offered.push_back(static_cast<int>(p));
      person.hints.markers.push_back(own >= 0 && own < person.body->num_markers() ? own : -1);
      person.hints.worth.push_back(kHint * share);
    }
    for (Person& person : persons_) person.points = points.p_WP(Eigen::all, person.offered);
  }

  /// votes: null, or what the frame adds to.
  void Track(int k, const TrackNames& before, TrackVotes* votes) {
    Offer(k, before);
    for (Person& person : persons_) {
      Vote(k, person, person.tracker->Track(person.points, dt_, &person.hints), 0.25, votes);
    }
  }

  void Vote(int k, const Person& person, const std::vector<int>& point_of_marker, double weight,
            TrackVotes* votes) const {
    for (int m = 0; m < person.body->num_markers() && votes != nullptr; ++m) {
      if (point_of_marker[m] < 0) continue;
      const int track = tracks_.frames[k].tracks[person.offered[point_of_marker[m]]];
      (*votes)[track][person.first_marker + m] += weight;
    }
  }

  /// Forward over the recording, and back again; on the way back each frame is judged by what came
  /// before and after it. Predictions of the way forward are kept for a part at a time.
  TrackNames ForwardAndBackward(const TrackNames& before) {
    TrackVotes votes(tracks_.tracks.size());
    const int frames = static_cast<int>(tracks_.frames.size());
    std::vector<std::vector<LabelBelief>> starts;  // of the parts
    for (int k = 0; k < frames; ++k) {
      if (k % kPart == 0) starts.push_back(Beliefs());
      Track(k, before, &votes);
      Show(k);
    }
    Reverse();
    std::vector<LabelBelief> backward = Beliefs();
    std::vector<std::vector<LabelTracker::Prediction>> predictions;  // by frame, by person
    for (int part = static_cast<int>(starts.size()) - 1; part >= 0; --part) {
      const int begin = part * kPart;
      const int end = std::min(begin + kPart, frames);
      predictions.clear();
      Restore(starts[part]);
      for (int k = begin; k < end; ++k) {
        Track(k, before, nullptr);
        predictions.emplace_back();
        for (const Person& person : persons_) {
          predictions.back().push_back(person.tracker->prediction());
        }
      }
      Restore(backward);
      for (int k = end - 1; k >= begin; --k) {
        Track(k, before, &votes);
        for (std::size_t i = 0; i < persons_.size(); ++i) {
          Person& person = persons_[i];
          const std::vector<int>& between =
              person.tracker->Between(person.points, predictions[k - begin][i], &person.hints);
          Vote(k, person, between, 0.5, &votes);
          if (before.markers.empty() && IsUncalibrated(person.setup)) {
            LookElsewhere(k, person, between);
          }
        }
      }
      backward = Beliefs();
    }
    Reverse();
    return ResolveVotes(votes, tracks_, static_cast<int>(name_of_marker_.size()), kLeastShare);
  }

  /// For where an uncalibrated person's markers without a point in this frame are worn.
  void LookElsewhere(int k, const Person& person, const std::vector<int>& point_of_marker) {
    std::vector<char> is_used(person.offered.size(), 0);
    for (const int point : point_of_marker) {
      if (point >= 0) is_used[point] = 1;
    }
    for (int m = 0; m < person.body->num_markers(); ++m) {
      if (point_of_marker[m] >= 0 || person.tracker->deviations()[m] > kKnown) continue;
      for (std::size_t p = 0; p < is_used.size(); ++p) {
        const int track = tracks_.frames[k].tracks[person.offered[p]];
        const PointTrack& points = tracks_.tracks[track];
        if (is_used[p] != 0 || points.end - points.begin < WornElsewhere::kLeastFrames) continue;
        const Vector3d p_WP = person.points.col(static_cast<Eigen::Index>(p));
        elsewhere_.Add(person.first_marker + m, track, person.tracker->OffsetOf(m, p_WP), p_WP);
      }
    }
  }

  /// Tracks without a name become markers that mostly have none.
  void NameElsewhere(TrackNames* names) const {
    std::vector<int> frames(name_of_marker_.size(), 0);
    for (std::size_t t = 0; t < tracks_.tracks.size(); ++t) {
      const PointTrack& track = tracks_.tracks[t];
      if (names->markers[t] >= 0) frames[names->markers[t]] += track.end - track.begin;
    }
    for (const auto& [marker, track] : elsewhere_.Find(dt_)) {
      if (names->markers[track] >= 0 || 2 * frames[marker] > recording_.num_frames()) continue;
      names->markers[track] = marker;
      names->shares[track] = 1;
    }
  }

  /// Whoever was only scaled by height is calibrated on what has surely got its name. True: someone
  /// was.
  bool Calibrate(const TrackNames& names) {
    bool is_anyone = false;
    for (Person& person : persons_) {
      if (IsUncalibrated(person.setup) && CalibrateOne(names, &person)) is_anyone = true;
    }
    return is_anyone;
  }

  bool CalibrateOne(const TrackNames& names, Person* person) {
    std::vector<std::string> labels;
    std::vector<MarkerAssignment> assignments = person->setup.assignments();
    for (std::size_t m = 0; m < assignments.size(); ++m) {
      labels.push_back(std::to_string(m));
      assignments[m].label = LabelIx(static_cast<int>(m));
    }
    MarkerSequence named(labels, recording_.num_frames(), recording_.rate(),
                         recording_.first_time());
    for (std::size_t t = 0; t < tracks_.tracks.size(); ++t) {
      const PointTrack& track = tracks_.tracks[t];
      const int marker = names.markers[t] - person->first_marker;
      if (marker < 0 || marker >= person->body->num_markers() || names.shares[t] < kSure) continue;
      for (int k = track.begin; k < track.end; ++k) {
        named.frame(k).col(marker) = tracks_.frames[k].p_WP.col(track.points[k - track.begin]);
      }
    }
    TrackingSetup& setup = person->setup;
    try {
      const CalibrationResult result =
          CalibrateSubject(*setup.model, setup.joints, {{"", &named, assignments}}, {});
      setup.model =
          std::make_shared<const KinematicModel>(FitToSubject(*setup.model, result.subject));
      person->body = std::make_unique<LabelBody>(setup);
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

  std::vector<Person> persons_;
  const std::vector<LabelObject>& objects_;
  std::vector<int> name_of_marker_;
  const MarkerSequence& recording_;
  PointTracks tracks_;
  std::vector<char> is_object_;  // by track
  WornElsewhere elsewhere_;
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
    if (markers >= kFewestNames) continue;
    throw Error(fmt::format(
        "{} with {} markers can't be found among points; at least {} are needed",
        i == 0 ? "a body" : fmt::format("the body of person {}", i + 1), markers, kFewestNames));
  }
  for (int k = 0; k < recording.num_frames(); ++k) {
    const auto seen = recording.frame(k).row(0).array().isFinite().count();
    if (seen > kMostPoints) {
      throw Error(
          fmt::format("frame {} has {} points; at most {} can be labelled", k, seen, kMostPoints));
    }
    if (seen > kMostPointsWithObjects && !scene.objects.empty()) {
      throw Error(fmt::format("frame {} has {} points; objects can be found among {} at most", k,
                              seen, kMostPointsWithObjects));
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
