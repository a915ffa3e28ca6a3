// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <random>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/fit/posture_search.h"
#include "common/model/marker_kinematics.h"
#include "plugins/s2kf/marker_filter.h"
#include "plugins/s2kf/marker_gate.h"
#include "plugins/s2kf/s2kf_settings.h"

namespace mmm_converter::s2kf {

/// Tracks by MarkerFilter, starts by PostureSearch, and watches the track: in frames where it is in
/// doubt (just started, markers back after a gap, distances well above their usual level) a
/// least-squares fit looks for a clearly better posture, from which the filter then goes on.
class S2kfConverter : public MotionConverter {
 public:
  S2kfConverter(const TrackingSetup& setup, const S2kfSettings& settings);

  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override;
  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, double dt) override;

  /// With smoothing, postures, deviations and residuals are the smoothed ones; what a frame's
  /// diagnostic tells is of the filter.
  ConversionResult Convert(const MarkerSequence& recording,
                           const std::function<bool(int)>& progress) override;

 private:
  /// All that a track carries from one frame to the next.
  struct TrackState {
    Belief belief;
    std::vector<double> hidden_for;  // by assignment [s]
    double usual_distance = 0;       // running level of ClippedDistance [m]
    bool far = false;                // distances are well above their usual level
    int doubt = 0;                   // frames for which the track stays in doubt
    std::mt19937 random;             // of the search
    MarkerGate::State gate;
  };

  /// What smoothing needs of a track: its state at evenly spaced frames, from which the filter can
  /// do the same again.
  struct Checkpoints {
    int first = -1;  // the first tracked frame
    std::vector<TrackState> states;
    // Postures from which the filter goes on in a frame, as a later frame showed them to be better.
    std::map<int, Posture> retakes;
  };

  void KeepCheckpoint(int k, Checkpoints* checkpoints);
  /// Where the track was taken up anew, goes backwards from there as long as that is nearer to the
  /// markers than the track was: the frame in which it ends is where to take it up.
  void FindRetakes(const MarkerSequence& recording, const ConversionResult& result,
                   Checkpoints* checkpoints);
  void TrackFromRetakes(const MarkerSequence& recording, Checkpoints* checkpoints);
  void Restore(const Checkpoints& checkpoints, int chunk);
  void Retake(const MarkerSequence& recording, int k, const Checkpoints& checkpoints);
  void TrackAgain(const MarkerSequence& recording, int k, const Checkpoints& checkpoints);
  void Smooth(const MarkerSequence& recording, const Checkpoints& checkpoints,
              ConversionResult* result);
  /// Whether a smoothed posture is about as near to the gathered markers as the filter's.
  bool IsAsNear(const Belief& smoothed, const Belief& filtered);
  /// ClippedMean of the gathered markers' distances from those of a belief, which it places [m].
  double MeasuredDistance(const Belief& belief);
  /// Mean of the finite ones, each counted up to the robust distance [m]; 0 where there is none.
  double ClippedMean(const Eigen::VectorXd& distances) const;
  void WriteSmoothed(const MarkerSequence& recording, int k, const Belief& belief,
                     ConversionResult* result);
  /// Takes the assigned markers out of a frame into measured_; returns how many are seen.
  int Gather(const Eigen::Ref<const Eigen::Matrix3Xd>& frame);
  /// Updates the belief by the markers that pass the gate, which are then z_.
  MarkerFilter::Outcome Update();
  MarkerFilter::Outcome UpdateBySelected();
  /// Finds what is wrong in a suspicious frame, and updates without it.
  void Judge(MarkerFilter::Outcome* outcome);
  /// Puts a belief's posture into posture_ and at_.
  void Place(const Belief& belief);
  /// Mean distance between z_ and the belief's markers, each counted up to the robust distance [m].
  double ClippedDistance();
  bool IsInDoubt(double distance, double dt);
  /// Looks for a better posture; true where the filter was set onto one.
  bool Recover();
  /// Where many markers are left out: true where a posture explains them as well as the others, and
  /// the filter was set onto it.
  bool Reopen();
  void FillEstimate(const MarkerFilter::Outcome& outcome, bool reassembled);

  S2kfSettings settings_;
  MarkerKinematics kinematics_;
  std::vector<int> labels_;  // by assignment
  Eigen::VectorXd noise_scale_;
  MarkerFilter filter_;
  MarkerGate gate_;
  PostureSearch search_;
  PostureFitOptions fit_options_;
  MarkerJacobian at_;

  TrackState track_;
  Belief prior_;               // of this frame
  Eigen::Matrix3Xd measured_;  // by label
  Eigen::Matrix3Xd z_;         // what is tracked
  Posture posture_;            // tracked joints
  Posture candidate_;          // tracked joints
  Eigen::VectorXd deviations_;
  FrameEstimate estimate_;
};

}  // namespace mmm_converter::s2kf
