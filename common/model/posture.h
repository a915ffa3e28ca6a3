// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mmm_converter {

class KinematicModel;

/// Markers that must be seen for a pose in space to be determined.
inline constexpr int kFewestMarkers = 3;

/// A posture of a KinematicModel: pose X_WS of the root and all joint angles.
struct Posture {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< root origin in W [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< root R_WS, unit
  Eigen::VectorXd joint_angles;  ///< [rad], sliding [m], size num_joints()
};

/// The posture with the root at the origin and upright (KinematicModel::standing), or the fixed
/// root where it is, and every joint at rest (0), clamped into its limits.
Posture ZeroPosture(const KinematicModel& model);

/// Where joints are that are not tracked [rad], sliding [m]; size num_joints().
Eigen::VectorXd RestAngles(const KinematicModel& model);

/// q moved by the tangent vector dq = [root position (W) 3; rotation (body) 3; joint angles]:
/// orientation * Exp(dq[3..5]).
Posture Retract(const Posture& q, const Eigen::Ref<const Eigen::VectorXd>& dq);

/// The tangent vector with Retract(q0, Local(q0, q1)) == q1.
Eigen::VectorXd Local(const Posture& q0, const Posture& q1);

}  // namespace mmm_converter
