// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mmm_converter::s2kf {

/// How the root orientation o is a part of the state.
enum class RootParameters {
  kSo3,  ///< unit quaternion; the error state is a rotation vector in the body, R = R_0 Exp(o)
  kRpy,  ///< the paper's: roll, pitch, yaw themselves
};

/// Gaussian belief about the state x = [r (root position, W) 3; o (root orientation) 3; Theta
/// (joint parameters) J], and its rate where the motion model has one.
struct Belief {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< r [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_WS (RPY: made from rpy)
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();                    ///< kRpy only [rad]
  Eigen::VectorXd parameters;                                       ///< Theta, J
  Eigen::VectorXd rate;  ///< d/dt of the error state, 6 + J; size 0 without velocities
  Eigen::MatrixXd P;     ///< covariance of [error state; rate]

  int num_states() const { return 6 + static_cast<int>(parameters.size()); }
};

/// x moved by dx = [r; o; Theta].
void Move(const Eigen::Ref<const Eigen::VectorXd>& dx, RootParameters root, Belief* belief);

}  // namespace mmm_converter::s2kf
