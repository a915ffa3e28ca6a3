// SPDX-License-Identifier: MIT
#include "common/retarget/limb_directions.h"

#include <cmath>
#include <numbers>

namespace mmm_converter {
namespace {

constexpr double kSteepest = 60;  // [deg] of a pelvis whose heading is known

}  // namespace

LimbDirections DirectionsOf(const BodyMap& map, const BodyPosture& body, bool by_chest) {
  LimbDirections directions;
  const Eigen::Vector3d left = by_chest ? body.R_chest.col(1) : body.R_pelvis.col(1);
  directions.is_known = std::abs(left.z()) < std::sin(kSteepest * std::numbers::pi / 180);
  directions.heading = std::atan2(-left.x(), left.y());
  const Eigen::AngleAxisd back(-directions.heading, Eigen::Vector3d::UnitZ());
  const auto add = [&](bool is_there, const LimbPosture& limb) {
    if (!is_there) return;
    directions.limbs[directions.count++] = back * UpperDirection(limb);
    directions.limbs[directions.count++] = back * LowerDirection(limb);
  };
  for (std::size_t i = 0; i < 2; ++i) add(map.legs[i].has_value(), body.legs[i]);
  for (std::size_t i = 0; i < 2; ++i) add(map.arms[i].has_value(), body.arms[i]);
  return directions;
}

std::vector<std::string> NamesOfLimbs(const BodyMap& map) {
  std::vector<std::string> names;
  for (const Side side : kSides) {
    if (!map.leg(side)) continue;
    names.push_back(std::string(Name(side)) + " thigh");
    names.push_back(std::string(Name(side)) + " shank");
  }
  for (const Side side : kSides) {
    if (!map.arm(side)) continue;
    names.push_back(std::string(Name(side)) + " upper arm");
    names.push_back(std::string(Name(side)) + " forearm");
  }
  return names;
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace mmm_converter
