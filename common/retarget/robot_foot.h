// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/model/robot.h"
#include "common/retarget/body_map.h"
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

/// X_WS: of the robot at its zero pose. @throws Error where it is not known where its sole is.
RobotFoot FindFoot(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS,
                   const BodyMap& map, Side side, const SoleChoice& choice);

}  // namespace mmm_converter
