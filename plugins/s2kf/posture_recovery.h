// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "common/fit/posture_search.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "plugins/s2kf/track_watch.h"
#include "plugins/s2kf/tracked_frame.h"
#include "plugins/s2kf/tracked_markers.h"

namespace mmm_converter::s2kf {

/// Least squares with the settings' robust distance.
PostureFitOptions FitOptions(const S2kfSettings& settings);

/// Finds postures by least squares where a filter has none or a wrong one: the first, and better
/// ones for frames in doubt, as TrackWatch decides. What is found stands in *posture (tracked
/// joints), which must not be frame.posture. Nothing is allocated after construction.
class PostureRecovery {
 public:
  /// markers must outlive it.
  PostureRecovery(const TrackedMarkers& markers, const S2kfSettings& settings);

  /// From nothing; frame.measured shows at least three markers. random: set.
  void Assemble(const TrackedFrame& frame, std::mt19937* random, Posture* posture);

  /// True where a posture near frame.posture, or one of its random restarts, is clearly better for
  /// frame.z.
  bool FindBetter(const TrackedFrame& frame, const TrackWatch& watch, std::mt19937* random,
                  Posture* posture);

  /// As far from `held` as the markers of frame.z that came back ask for, or from nothing where
  /// that is clearly better.
  void FindAgain(const TrackedFrame& frame, const Posture& held, const TrackWatch& watch,
                 std::mt19937* random, Posture* posture);

  /// True where so many markers are left out of frame.z that they may be right, and a posture
  /// explains them as well as the others.
  bool FindForAll(const TrackedFrame& frame, int left_out, const TrackWatch& watch,
                  Posture* posture);

 private:
  PostureFitOptions options_, search_options_;
  int start_attempts_;
  /// Of the markers, so that costs are those of markers of scale 1, which TrackWatch knows.
  Eigen::VectorXd scale_;
  PostureSearch search_;
  Posture fresh_;
};

}  // namespace mmm_converter::s2kf
