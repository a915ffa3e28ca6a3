// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/model/robot.h"
#include "common/retarget/aim_weights.h"
#include "common/retarget/body_map.h"
#include "common/retarget/robot_capsules.h"
#include "common/retarget/robot_foot.h"
#include "common/retarget/trajectory_fit.h"

namespace mmm_converter {

/// A robot with what a motion is brought to it by.
struct RobotBody {
  BodyMap map;
  std::optional<std::array<RobotFoot, 2>> feet;  ///< nothing: it has no legs
  /// Thigh, shank and ankle height; without legs upper arm and forearm [m].
  double size = 0;
  double hip_width = 0;  ///< [m]
  RobotCapsules capsules;
  std::vector<FloorBall> balls;  ///< of arms, trunk and knees: with them, too, it stays above z = 0
  std::array<BodyPoint, 2> palms;  ///< of hands (PalmOf); segment -1: it has no such arm
  Eigen::VectorXd rest;            ///< of all joints, where nothing moves them
  /// Of the root where it has no legs: as its file says, or floating, so high that it stands [m].
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  std::vector<int> held;  ///< joints that stay there (held_joints.h)
  AimWeights weights;
};

/// Why the motion may not be what is wanted, of its soles or its base; empty: nothing.
std::string DoubtOf(const Robot& robot, const RobotBody& body);
/// Puts RobotBody::base where the lowest point of the robot at rest is on the floor.
void PlaceBase(const Robot& robot, RobotBody* body);

/// FindBodyMap. @throws Error as that, and where the file ties a knee or an elbow to another joint
/// of the limb.
BodyMap FindRobotMap(const Robot& robot, const BodyMapChoice& choice);

/// @throws Error as FindBodyMap, and where it is not known where a sole is, or the robot is not in
/// metres.
RobotBody FindRobotBody(const Robot& robot, const BodyMapChoice& choice, const SoleChoice& sole);

}  // namespace mmm_converter
