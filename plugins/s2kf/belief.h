// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "plugins/s2kf/joint_limit_transform.h"

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

  /// To the last bit; all numbers must be.
  bool operator==(const Belief& other) const = default;
  int num_states() const { return 6 + static_cast<int>(parameters.size()); }
};

/// x moved by dx = [r; o; Theta].
void Move(const Eigen::Ref<const Eigen::VectorXd>& dx, RootParameters root, Belief* belief);

/// The root moved by `dr`, and turned by `turn` as Move does.
void MoveRoot(const Eigen::Vector3d& dr, const Eigen::Vector3d& turn, RootParameters root,
              Belief* belief);

/// dx with Move(dx, a) = b: of the states, then, where there are rates, of these.
void Difference(const Belief& a, const Belief& b, RootParameters root, Eigen::VectorXd* dx);

/// The same belief with its sign of joint parameter j turned in rate and covariance.
void Mirror(int j, Belief* belief);

/// The same belief with every joint parameter in [-pi/2, pi/2] (JointLimitTransform::Fold).
void Fold(const JointLimitTransform& transform, Belief* belief);

}  // namespace mmm_converter::s2kf
