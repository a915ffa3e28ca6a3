// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/model_points.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// A rigid object that was recorded beside the person.
struct ObjectMotion {
  std::string name;
  PoseTrajectory trajectory;
};

/// The pose of a rigid body at that time [s], W; between two frames interpolated; NaN: not known.
Eigen::Isometry3d PoseAt(const PoseTrajectory& body, double time);

/// What of a body is asked for.
struct BodySelection {
  std::vector<int> segments;  ///< of the model
  std::vector<ObjectMotion> objects;
  std::vector<ModelPoint> points;
  bool relative_to_root = false;  ///< in the root's frame instead of the world
};

/// Segments, objects and points in the world, or in the frame of the model's root: a column a
/// frame, so that the data lies as frames x bodies x numbers.
struct BodyPoses {
  double rate = 0;        ///< [Hz]
  double first_time = 0;  ///< [s]
  bool relative_to_root = false;
  std::vector<std::string> segments, objects, points;
  /// Bodies are the segments, then the objects: x, y, z of each origin [m]; NaN: an object that was
  /// not recorded at that time.
  Eigen::MatrixXd positions;
  Eigen::MatrixXd quaternions;      ///< w, x, y, z of each body, without jumps of the sign
  Eigen::MatrixXd point_positions;  ///< [m]
  Eigen::MatrixXd center_of_mass;   ///< [m]; empty: the model has no mass
  // Empty where the trajectory has no velocities. Those in the root's frame are what is seen from
  // there; objects have none.
  Eigen::MatrixXd velocities;               ///< of the segments' origins [m/s]
  Eigen::MatrixXd angular_velocities;       ///< of the segments [rad/s], axes of the same frame
  Eigen::MatrixXd point_velocities;         ///< [m/s]
  Eigen::MatrixXd center_of_mass_velocity;  ///< [m/s]

  int num_frames() const { return static_cast<int>(positions.cols()); }
  int num_bodies() const { return static_cast<int>(segments.size() + objects.size()); }
  double time(int k) const { return first_time + k / rate; }
};

/// Forward kinematics of all frames. Joints that the trajectory does not name are as in
/// ZeroPosture. An object's pose between two of its frames is interpolated.
/// @throws Error where the trajectory names a joint that the model does not have.
BodyPoses ComputeBodyPoses(const KinematicModel& model, const PoseTrajectory& motion,
                           const BodySelection& selection);

}  // namespace mmm_converter
