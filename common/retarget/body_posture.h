// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "common/retarget/body_map.h"

namespace mmm_converter {

/// A limb in W: centres [m], axes of its halves and its end (LimbSegment, LimbMap::R_ED).
struct LimbPosture {
  Eigen::Vector3d proximal, middle, distal;
  Eigen::Matrix3d R_upper, R_lower, R_end;
};

/// A mapped body, a person's or a robot's, in one frame, W. Limbs that it has not are not set.
struct BodyPosture {
  Eigen::Matrix3d R_pelvis, R_chest;  ///< columns: forward, left, up
  Eigen::Vector3d mid_hip;            ///< of a body without legs the pelvis' origin [m]
  std::array<LimbPosture, 2> legs, arms;
};

BodyPosture PostureOfBody(const BodyMap& map, const std::vector<Eigen::Isometry3d>& X_WS);

/// Of a limb's half the direction towards its proximal centre, without the part along the fold
/// axis, W.
inline Eigen::Vector3d UpperDirection(const LimbPosture& limb) { return limb.R_upper.col(2); }
inline Eigen::Vector3d LowerDirection(const LimbPosture& limb) { return limb.R_lower.col(2); }

}  // namespace mmm_converter
