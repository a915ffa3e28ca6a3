// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "plugins/s2kf/update_outcome.h"

namespace mmm_converter::s2kf {

/// What a tracker knows of one frame.
struct TrackedFrame {
  /// Sized once.
  explicit TrackedFrame(const MarkerKinematics& kinematics);

  Eigen::Matrix3Xd measured;    ///< by label, 3 x markers [m]; NaN: not seen
  int seen = 0;                 ///< in `measured`
  Eigen::Matrix3Xd relabelled;  ///< `measured` with swapped ones exchanged
  Eigen::Matrix3Xd z;           ///< what is tracked: without wrong markers, swapped ones exchanged
  UpdateOutcome outcome;        ///< of the last update, by z
  Posture posture;              ///< the estimate, tracked joints
  MarkerJacobian at;            ///< its markers (p_WM) and links
  bool reassembled = false;     ///< the track was lost here; the posture was assembled again
};

/// How many of the markers are seen; z: 3 x markers, NaN = not seen.
int CountSeen(const Eigen::Matrix3Xd& z);

/// Mean of the finite distances between the columns of a and b [m], each counted up to `limit`; 0
/// where there is none.
double ClippedMeanDistance(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b, double limit);

}  // namespace mmm_converter::s2kf
