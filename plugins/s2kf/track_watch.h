// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/fit/posture_fit.h"

namespace mmm_converter::s2kf {

/// Decides when a track is in doubt, so that a least-squares fit looks for a better posture, and
/// when a posture that was found replaces the filter's. Knows distances and costs only. State in,
/// state out: Start with the first frame, IsInDoubt once in each later one, Recovered where a
/// posture was replaced.
class TrackWatch {
 public:
  struct State {
    std::vector<double> hidden_for;  ///< by marker [s]
    double step = 0;                 ///< to the last frame [s]
    double usual_distance = 0;       ///< running level of the distance [m]
    bool is_far = false;             ///< the distance is well above its usual level
    int doubt = 0;                   ///< frames for which the track stays in doubt
  };

  /// marker_deviation: of each coordinate of a marker, as TrackedMarkers::UsualDeviation [m].
  TrackWatch(double marker_deviation, bool is_smoothed);

  /// distance: mean of the first frame's markers from the estimate's [m]. A new track is in doubt.
  void Start(int num_markers, double distance, State* state) const;

  /// A frame dt [s] after the last, with fewer than three markers; otherwise IsInDoubt does it.
  /// Returns how many came back after a long time.
  int TakeHidden(const Eigen::Matrix3Xd& z, double dt, State* state) const;

  /// A frame dt [s] after the last, with three markers or more. z: as tracked, 3 x markers, NaN =
  /// not seen. distance: their mean from the estimate's [m].
  bool IsInDoubt(const Eigen::Matrix3Xd& z, double distance, double dt, State* state) const;

  /// Whether the person is back, as after a gap: a third of the markers are seen, and most of these
  /// were hidden for long. Arguments as IsInDoubt's, before that is asked.
  bool IsBack(const Eigen::Matrix3Xd& z, double dt, const State& state) const;

  /// The posture was replaced; distance: of the new one [m].
  void Recovered(double distance, State* state) const;

  /// Whether a posture that a fit found replaces the filter's. before, after: of both, on the
  /// same markers, of which so many of all are seen.
  bool IsClearlyBetter(const PostureFit::Result& before, const PostureFit::Result& after, int seen,
                       int all) const;

  /// Whether markers are left out together that may be right together.
  bool MayBeRight(int left_out) const;

  /// Whether a posture that was fitted to all markers explains those that are left out about as
  /// well as the others. Costs: of so many markers at that posture.
  bool ExplainsLeftOut(double used_cost, int used, double left_out_cost, int left_out) const;

 private:
  double marker_deviation_;  // [m]
  bool is_smoothed_;
};

}  // namespace mmm_converter::s2kf
