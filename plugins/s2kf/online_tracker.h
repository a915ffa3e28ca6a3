// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "plugins/s2kf/gated_update.h"
#include "plugins/s2kf/marker_filter.h"
#include "plugins/s2kf/posture_recovery.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "plugins/s2kf/track_state.h"
#include "plugins/s2kf/tracked_frame.h"
#include "plugins/s2kf/tracked_markers.h"

namespace mmm_converter::s2kf {

/// Tracks frame by frame: predicts, updates by the markers that are right, and in frames where
/// TrackWatch doubts the track goes on from a posture that a least-squares fit found.
/// State in, state out; what it holds is scratch and constants. points: 3 x labels of the recording
/// [m], NaN = not seen.
class OnlineTracker {
 public:
  /// markers must outlive the tracker.
  OnlineTracker(const TrackedMarkers& markers, const S2kfSettings& settings);

  /// The first frame, from nothing. state and frame: results.
  /// @throws Error where fewer than three markers are seen.
  void Start(const Eigen::Ref<const Eigen::Matrix3Xd>& points, TrackState* state,
             TrackedFrame* frame);

  /// The frame dt [s] after that of `state`, which becomes this frame's. Any number of markers may
  /// be unseen. frame: result. Allocates nothing.
  void Track(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double dt, TrackState* state,
             TrackedFrame* frame);

  /// What Track from `state` by dt [s] does before it looks at the points. Changes no result.
  void Prepare(double dt, const TrackState& state);

  /// As Track, without looking for another posture.
  void Step(const Eigen::Ref<const Eigen::Matrix3Xd>& points, double dt, TrackState* state,
            TrackedFrame* frame);

  /// Takes the track up at another posture in the frame that was tracked last.
  void TakeUp(const Posture& posture, TrackState* state, TrackedFrame* frame);

  /// Mean distance between the markers, those left out too, and the estimate's; clipped [m].
  double DistanceOfAll(const TrackedFrame& frame) const {
    return ClippedMeanDistance(frame.relabelled, frame.at.p_WM, clip_);
  }

  const TrackedMarkers& markers() const { return markers_; }
  /// Holds nothing of a track.
  MarkerFilter& filter() { return filter_; }

 private:
  void Update(TrackState* state, TrackedFrame* frame) {
    update_.Update(&filter_, &state->belief, &state->gate, frame);
  }
  /// Predicts, and takes the markers that have been gathered.
  void StepTo(double dt, TrackState* state, TrackedFrame* frame);
  /// After a gap: takes the track up where the markers are, from the posture before it.
  void Return(double dt, TrackState* state, TrackedFrame* frame);
  /// Where many markers are left out: takes the track up at a posture that explains them, too.
  bool Reopen(TrackState* state, TrackedFrame* frame);
  /// Takes the track up at a clearly better posture, where there is one.
  bool Recover(TrackState* state, TrackedFrame* frame);
  /// Mean distance between what is tracked and the estimate's markers, clipped [m].
  double Distance(const TrackedFrame& frame) const;

  const TrackedMarkers& markers_;
  S2kfSettings settings_;
  double clip_;  // [m]
  MarkerFilter filter_;
  GatedUpdate update_;
  TrackWatch watch_;
  PostureRecovery recovery_;
  Posture candidate_, held_;
  Belief prepared_;
};

}  // namespace mmm_converter::s2kf
