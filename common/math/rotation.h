// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mmm_converter {

/// Rotation matrix of MMM's RootRotation (roll, pitch, yaw) [rad]: R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Matrix3d RotationFromRpy(const Eigen::Vector3d& rpy);

/// Inverse of RotationFromRpy with pitch in [-pi/2, pi/2]; at |pitch| = pi/2 roll is 0.
Eigen::Vector3d RpyFromRotation(const Eigen::Matrix3d& R);

/// The triple equal to `rpy` as a rotation that lies nearest to `previous`, so that a written
/// sequence has no jumps of 2 pi nor between the two Euler branches.
Eigen::Vector3d ContinuousRpy(const Eigen::Vector3d& rpy, const Eigen::Vector3d& previous);

/// Roll, pitch and yaw of one orientation after the other, each near to the one before.
class RpySeries {
 public:
  const Eigen::Vector3d& Next(const Eigen::Quaterniond& orientation);

 private:
  Eigen::Vector3d rpy_ = Eigen::Vector3d::Zero();
  bool is_first_ = true;
};

/// SO(3) exponential: the unit quaternion that rotates by |w| radians about w.
Eigen::Quaterniond Exp(const Eigen::Vector3d& w);

/// SO(3) logarithm, |result| <= pi; Exp(Log(q)) is q or -q.
Eigen::Vector3d Log(const Eigen::Quaterniond& q);

/// Right Jacobian of SO(3): Exp(w + dw) = Exp(w) Exp(Jr(w) dw) to first order.
Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& w);

/// The rotation by the least angle that takes the direction of a to that of b, neither of them
/// zero. Of opposite directions it is one about some normal of theirs.
Eigen::Matrix3d RotationBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// The rotation R with the largest trace of R^T M: the nearest one to M, and of M = sum z p^T the
/// one that takes the points p nearest to the z (Umeyama 1991, eq. 39 to 43).
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& M);

/// The matrix [w] with [w] v = w x v.
Eigen::Matrix3d Skew(const Eigen::Vector3d& w);

}  // namespace mmm_converter
