// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/model/robot.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// The order in which files have joints and bodies.
enum class RobotOrder {
  kDepthFirst,   ///< of the robot's file, as MuJoCo has them
  kBreadthFirst  ///< by the number of moving joints above, as Isaac has them
};

/// The motion of a robot as files of robot learning have it: a column a frame, so that data lies
/// as frames x numbers. Joints are all that the file moves, those that follow others too.
struct RobotMotion {
  double rate = 0;  ///< [Hz]
  bool is_root_fixed = false;
  std::vector<std::string> joints;
  std::vector<int> joint_segments;
  Eigen::MatrixXd root_positions;    ///< [m]
  Eigen::MatrixXd root_quaternions;  ///< w x y z, of length 1, without jumps of the sign
  Eigen::MatrixXd joint_positions;   ///< [rad], sliding [m]
  // Central differences.
  Eigen::MatrixXd root_velocities;          ///< in W [m/s]
  Eigen::MatrixXd root_angular_velocities;  ///< in W [rad/s]
  Eigen::MatrixXd joint_velocities;         ///< [rad/s], sliding [m/s]

  Eigen::Index num_frames() const { return root_positions.cols(); }
};

/// At that rate (Resample), all joints in that order. Joints that the motion does not name rest.
/// @throws Error where it has no frames or names a joint that the robot does not have.
RobotMotion MakeRobotMotion(const Robot& robot, const PoseTrajectory& trajectory,
                            std::optional<double> rate, RobotOrder order);

/// Of a rigid object: without joints.
RobotMotion MakeObjectMotion(const PoseTrajectory& poses, std::optional<double> rate);

/// Bodies of the robot: all of its file, or the root and those that a joint moves, which is what is
/// left where simulators merge the others into them. Indices into Robot::links.
std::vector<int> AllLinks(const Robot& robot);
std::vector<int> MovingLinks(const Robot& robot, RobotOrder order);

/// Of bodies over time, a column a frame.
struct LinkPoses {
  std::vector<std::string> names;
  Eigen::MatrixXd positions;           ///< [m]
  Eigen::MatrixXd quaternions;         ///< w x y z, without jumps of the sign
  Eigen::MatrixXd velocities;          ///< in W [m/s]
  Eigen::MatrixXd angular_velocities;  ///< in W [rad/s]
};

/// As MakeRobotMotion. relative_to_root: positions and orientations in the root's frame, without
/// velocities.
LinkPoses MakeLinkPoses(const Robot& robot, const PoseTrajectory& trajectory,
                        std::optional<double> rate, const std::vector<int>& links,
                        bool relative_to_root);

}  // namespace mmm_converter
