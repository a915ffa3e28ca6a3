// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/label/search/label_body.h"
#include "common/label/track/body_watch.h"
#include "common/label/track/label_tracker.h"
#include "common/label/track/point_tracks.h"
#include "common/label/track/track_names.h"
#include "common/label/track/worn_elsewhere.h"
#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// One of the persons of a recording that is labelled: who they are, where they are in this frame,
/// and what whole passes tell of their names.
class LabelledPerson {
 public:
  /// first_marker: the number of the first of this person's markers among those of all. tracks must
  /// outlive the person; dt [s]: of a frame.
  LabelledPerson(const TrackingSetup& setup, int first_marker, const PointTracks& tracks,
                 double dt);

  const LabelBody& body() const { return *body_; }
  LabelTracker& tracker() { return *tracker_; }
  const LabelTracker& tracker() const { return *tracker_; }
  bool was_calibrated() const { return was_calibrated_; }
  int first_marker() const { return first_marker_; }
  bool IsMarker(int marker) const {
    return marker >= first_marker_ && marker < first_marker_ + body_->num_markers();
  }
  /// Searches for the body where it was lost. After a few vain ones, which found nothing that fits
  /// or nothing better, no more are made: who is there would have been found, and a wrong recording
  /// would be searched all along. Nor are there more than one for each second of the recording.
  struct Searches {
    int made = 0, vain = 0;
  };
  const Searches& searches() const { return searches_; }
  void set_searches(const Searches& before) { searches_ = before; }

  /// Takes the person up with a tracker of their own.
  void Start(const BodyMatch& match);

  /// Tracks the points of this frame; where most of what could fit does not for long, as after the
  /// person was away, the body is looked for anew. The point of each marker, into offered.
  const std::vector<int>& Follow();

  /// What a pass made of a frame. point_of_marker: into offered.
  void KeepFrame(int frame, const std::vector<int>& point_of_marker);

  /// After a pass, by what was kept of it: names of whoever was calibrated before this recording
  /// are tried against each other; whoever is not gets names for what is worn far from the model's
  /// places.
  void Improve(TrackNames* names);

  /// Whoever was only scaled by height is calibrated on what has surely got its name, and taken up
  /// again where they are. True: this person was.
  bool Calibrate(const TrackNames& names, const std::function<void()>& between_steps = {});

  // Of this frame:
  std::vector<int> offered;  ///< points
  Eigen::Matrix3Xd points;   ///< these
  LabelTracker::Hints hints;
  Eigen::Matrix3Xd places;  ///< foreseen, of the markers
  Eigen::VectorXd variances;

 private:
  bool MaySearch() const;
  /// Markers without a point against points without a marker.
  void CountUnmatched(int frame, const std::vector<int>& point_of_marker);
  void NameWornElsewhere(TrackNames* names) const;
  /// The points that surely have names, by marker.
  MarkerSequence Named(const TrackNames& names) const;

  TrackingSetup setup_;
  bool was_calibrated_;  ///< before this recording
  bool is_calibrated_;
  int first_marker_;
  const PointTracks& tracks_;
  double dt_;
  int kept_every_;  ///< frames
  std::unique_ptr<LabelBody> body_;
  std::unique_ptr<LabelTracker> tracker_;
  Searches searches_;
  BodyWatch watch_ = BodyWatch(WatchTuning::kRecorded);
  std::vector<std::pair<int, Posture>> kept_;  ///< frames of this pass
  WornElsewhere elsewhere_;
};

}  // namespace mmm_converter
