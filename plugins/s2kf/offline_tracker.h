// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/motion/marker_sequence.h"
#include "plugins/s2kf/online_tracker.h"
#include "plugins/s2kf/reported_covariance.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "plugins/s2kf/track_state.h"
#include "plugins/s2kf/tracked_frame.h"

namespace mmm_converter::s2kf {

/// Makes the track of one whole recording better, by what later frames tell of earlier ones: takes
/// it up where a lost track could first have been taken up, then goes backwards over it
/// (TrajectorySmoother). Of the track every so manieth state is kept, from which the tracker does
/// the same again. Keep comes after each tracked frame, then Smooth once.
class OfflineTracker {
 public:
  /// All must outlive the object; `tracker` is what tracks the recording. markers: what residuals
  /// are told against; those of the tracker, or where the model has them.
  OfflineTracker(const MarkerSequence& recording, const S2kfSettings& settings,
                 const TrackedMarkers& markers, OnlineTracker* tracker);

  /// state, frame: after frame k; from the first tracked frame on, in order.
  void Keep(int k, const TrackState& state, const TrackedFrame& frame);

  /// After a frame before the first of Keep, tracked backward from there, the last one first.
  void KeepEarlier(const TrackState& state);

  /// result: of the tracker, all frames; its postures, standard deviations and residuals are
  /// replaced by the smoothed ones, its times grow. Frames of KeepEarlier have the filter's; those
  /// before them take the first one's posture.
  void Smooth(bool keeps_covariances, ConversionResult* result);

 private:
  struct Checkpoint {
    int frame = 0;
    TrackState state;
  };
  struct Estimate {
    Posture posture;
    Eigen::VectorXd deviations;  ///< as the belief has them, of white noise
  };

  /// Keeps the belief of frame k, and every so manieth state as a checkpoint.
  void KeepState(int k, const TrackState& state);
  /// Of frame k, the i-th of its part; takes the markers of the frame into frame_.
  void KeepBelief(int i, int k, const TrackState& state);

  /// Where the posture was assembled again, goes backwards from there as long as that is nearer to
  /// the markers than the track was: the frame in which it ends is where to take it up.
  void FindRetakes(const ConversionResult& result);
  void TrackFromRetakes();
  /// The track of frame k from that of the frame before.
  void TrackAgain(int k, TrackState* state);
  void Retake(int k, TrackState* state);
  void SmoothBackwards(ConversionResult* result);
  /// Takes the markers of frame k into frame_.
  void Gather(int k);
  /// Whether a smoothed posture is about as near to each of the markers z as the filter's.
  bool IsAsNear(const Eigen::Matrix3Xd& z, const Belief& smoothed, const Belief& filtered);
  /// Takes the markers_ of a posture into of_model_.
  void PlaceByModel(const Posture& q);
  void TakeEstimate(const Belief& belief, Estimate* estimate) const;
  void Write(int k, const Estimate& estimate, ConversionResult* result);
  /// Replaces these by what is said of the postures (ReportedCovariance).
  void ReportDeviations(bool keeps_covariances, ConversionResult* result);

  const MarkerSequence& recording_;
  const TrackedMarkers& markers_;
  OnlineTracker& tracker_;
  RootParameters root_;
  int chunk_;    // frames between checkpoints
  double clip_;  // a farther marker is a wrong one [m]
  double dt_;    // [s]
  std::vector<Checkpoint> checkpoints_;
  std::vector<Estimate> earlier_;
  /// Of the gate, markers x frames (GateState::verdicts).
  Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic> verdicts_;
  std::vector<double> distances_;  // of all markers in each frame [m]
  // Of the part that starts with the last checkpoint, then of the one that is smoothed: the
  // filter's belief and the markers that it was updated by.
  std::vector<Belief> filtered_;
  std::vector<Eigen::Matrix3Xd> used_;
  std::map<int, GateState>
      reassembled_;  // the gate in frames where the posture was assembled again
  // Postures from which the filter goes on in a frame, as a later frame showed them to be better.
  std::map<int, Posture> retakes_;
  TrackedFrame frame_;
  MarkerJacobian of_model_;  // places of markers_
  Eigen::RowVectorXd distances_of_filter_;
  ReportedCovariance covariance_;
  Estimate estimate_;  // of the frame that is written
  Eigen::VectorXd own_deviations_;
};

}  // namespace mmm_converter::s2kf
