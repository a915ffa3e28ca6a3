// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/model/robot.h"
#include "common/retarget/body_map.h"
#include "common/retarget/robot_capsules.h"
#include "common/retarget/trajectory_fit.h"

namespace mmm_converter {

/// A robot's foot as it meets the ground.
struct RobotFoot {
  int segment = 0;
  Eigen::Matrix3d R_FA = Eigen::Matrix3d::Identity();  ///< forward, left and up where it is flat
  /// In the segment [m]: the sole below the ankle, and where it touches last as it is tilted.
  Eigen::Vector3d sole, heel, toe;
  std::vector<ContactShape> shapes;
  std::vector<FloorBall> balls;    ///< points of these that stay above the floor
  std::vector<FloorBall> bearing;  ///< what may bear: the balls; of meshes many more corners
  /// Of each of bearing, forward and left of the sole: where it comes down as the foot rolls [m].
  std::vector<Eigen::Vector2d> rolled;
  double pivot = 0;         ///< height above the floor of what stays in place as it rolls [m]
  bool rolls = true;        ///< an ankle joint turns it about its length
  std::string said, doubt;  ///< as of Sole
  double ankle_height = 0;  ///< above the sole [m]
  double width = 0;         ///< of the sole [m]
};

/// Height of its lowest point [m].
double LowestOf(const RobotFoot& foot, const Eigen::Isometry3d& X_WF);

/// The pose that stands on z = 0, its sole at `place` if it were flat, its toes towards yaw,
/// turned by pitch [rad] (> 0: heel up) and roll about what then bears: that stays where it is of
/// the flat foot.
Eigen::Isometry3d StandingFoot(const RobotFoot& foot, const Eigen::Vector2d& place, double yaw,
                               double pitch, double roll);

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
  std::vector<int> held;           ///< joints that stay there (held_joints.h)
};

/// FindBodyMap. @throws Error as that, and where the file ties a knee or an elbow to another joint
/// of the limb.
BodyMap FindRobotMap(const Robot& robot, const BodyMapChoice& choice);

/// @throws Error as FindBodyMap, and where it is not known where a sole is, or the robot is not in
/// metres.
RobotBody FindRobotBody(const Robot& robot, const BodyMapChoice& choice, const SoleChoice& sole);

}  // namespace mmm_converter
