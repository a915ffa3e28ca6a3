// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/retarget/body_map.h"
#include "common/retarget/limb_chains.h"

namespace mmm_converter {

/// A chain with its knee or elbow, before it is known where forward is.
struct LimbReading {
  std::vector<int> chain;
  int fold = 0;    ///< of chain
  int beyond = 0;  ///< of chain: the first joint that is not of the fold (LastOfFold)
  bool is_leg = false;
  /// Of turning about the fold's axis, in which the end comes nearer; 0: its limits allow both
  /// alike.
  int sense = 0;
  double straight = 0;  ///< where the limb is longest [rad]
};

/// normal: level, across the way the body faces, W.
/// @throws Error naming the joints where two fold the chain alike and none is given (fold < 0).
LimbReading ReadLimb(const ZeroPose& zero, const std::vector<int>& chain, int fold, bool is_leg,
                     const Eigen::Vector3d& normal);

/// Ends the chain of a leg at its foot: joints in front of the ankle are toes.
void CutToes(const ZeroPose& zero, LimbReading* leg);

/// Where the end goes horizontally from the straight limb as it folds, W, of length 1 where that is
/// level; 0: its sense is not known.
Eigen::Vector3d FoldsTowards(const ZeroPose& zero, const LimbReading& limb);

/// forward: W at the zero pose; decides the fold axis' sense where the limits do not.
/// @throws Error naming the joint where neither does.
LimbMap MakeLimb(const ZeroPose& zero, const LimbReading& limb, const Eigen::Vector3d& forward);

/// The axes of a limb's half between two centres about its fold axis, all in W, and the segment.
LimbSegment MakeLimbSegment(int segment, const Eigen::Isometry3d& X_WS,
                            const Eigen::Vector3d& proximal, const Eigen::Vector3d& distal,
                            const Eigen::Vector3d& left);

}  // namespace mmm_converter
