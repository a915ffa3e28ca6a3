// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/retarget/body_posture.h"

namespace mmm_converter {

/// Where the halves of a body's limbs point to as the heading of its pelvis sees them. Limbs stand
/// in fours, legs first, left and right in twos.
struct LimbDirections {
  std::array<Eigen::Vector3d, 8> limbs;
  std::size_t count = 0;
  double heading = 0;    ///< about z [rad]
  bool is_known = true;  ///< the heading: the pelvis is not steep
};

/// map: of the robot, whose limbs count. by_chest: the chest's heading instead of the pelvis'.
LimbDirections DirectionsOf(const BodyMap& map, const BodyPosture& body, bool by_chest);

/// "left thigh"
std::vector<std::string> NamesOfLimbs(const BodyMap& map);

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace mmm_converter
