// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "common/retarget/human_body.h"

namespace mmm_converter {

/// A rigid object that was tracked beside a person.
struct TrackedObject {
  std::string name;
  std::vector<Eigen::Isometry3d> X_WO;  ///< in each of the person's frames [m]
  int begin = 0, end = 0;               ///< frames in which it is known
  Eigen::AlignedBox3d extent = {};      ///< of its markers, in O [m]; empty: not known
};

/// A hand that takes an object with it: frames [begin, end).
struct Hold {
  int object = 0;
  std::size_t hand = 0;  ///< 0: the left one
  int begin = 0, end = 0;
};

/// Of a person or a robot: the middle of the hand, beyond the wrist, W [m].
Eigen::Vector3d PalmOf(const LimbPosture& arm);

/// Where a palm stays near an object and keeps its place in it, while the object is moved.
std::vector<Hold> FindHolds(const HumanMotion& human, const std::vector<TrackedObject>& objects);

/// How much a hand's place counts in each frame: 1 while it holds something, rising before and
/// falling behind.
std::vector<double> WeightsOfHold(const std::vector<Hold>& holds, std::size_t hand, double rate,
                                  int frames);

/// In the robot's world, which is as much smaller as the robot is. floor: height of the person's
/// [m].
TrackedObject ScaledObject(TrackedObject object, double scale, double floor);

}  // namespace mmm_converter
