// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/model/posture.h"
#include "common/model/robot.h"

namespace mmm_converter {

/// What the user may say of a robot that follows. Nothing: LimitsOf has it.
struct FollowOptions {
  std::optional<double> joint_speed, joint_acceleration;  ///< [rad/s, rad/s^2]
  std::optional<double> root_speed;                       ///< [m/s]
  std::optional<double> rest_after;                       ///< [s] without a person
};

/// What a robot may do while it follows.
struct MotionLimits {
  Eigen::VectorXd speed, acceleration;  ///< [place 3 (m); rotation 3 (rad); joints], per s, s^2
  Eigen::VectorXd lower, upper;         ///< of joints
};
/// Speeds of joints as its file has them, at most what is asked for.
MotionLimits LimitsOf(const Robot& robot, const FollowOptions& options);

/// The tangent vector from one posture to another, of the right size already.
void DifferenceOf(const Posture& from, const Posture& to, Eigen::VectorXd* difference);

/// The speed at which a way [m, rad] is gone so that one stops at its end, slowing down by
/// `rise` [1/s^2] in frames of dt [s].
double StoppingSpeed(double way, double rise, double dt);

/// The speed of what moves at `speed` and is to be `missing` farther, where that moves at
/// `target_speed`.
double SpeedTowards(double target_speed, double missing, double rise, double dt);

/// Postures that go where they are to go, but no faster than limits allow, and come to a stop there
/// without going beyond: each joint by itself.
class MotionGovernor {
 public:
  explicit MotionGovernor(MotionLimits limits);

  const Posture& posture() const { return posture_; }
  const Posture& before() const { return before_; }  ///< the last frame
  bool has_started() const { return has_started_; }
  double fastest() const { return limits_.speed[0]; }  ///< of the root [m/s]
  bool is_blending() const { return elapsed_ < longest_blend(); }

  void Start(const Posture& posture);  ///< stands there
  void Stop() { speed_.setZero(); }    ///< stands where it is
  /// The next target goes on from where it is.
  void Join() { target_before_ = posture_; }
  /// Targets are another motion from now on, reached in a time [s] between these; more where the
  /// root has far to go.
  void Blend(const Posture& target, double shortest, double longest);
  void Go(const Posture& target, double dt);
  void Brake(double dt);

  /// Of the last Go: whether it got where it was to.
  bool is_behind() const { return is_behind_; }
  /// How far it may have gone in the last frame.
  const Eigen::VectorXd& least_way() const { return least_; }
  const Eigen::VectorXd& most_way() const { return most_; }
  /// It went there instead, which is as far as it may.
  void Correct(const Posture& posture, double dt);

 private:
  double longest_blend() const { return std::max(joint_blend_, root_blend_); }
  double BlendTime(Eigen::Index begin, Eigen::Index end) const;
  void Move(double dt);

  MotionLimits limits_;
  Posture posture_, before_, target_, target_before_;
  Eigen::VectorXd speed_, wanted_, target_speed_, missing_, least_, most_;
  Eigen::VectorXd off_, off_speed_;                        // of a blend, where it began
  double elapsed_ = 0, joint_blend_ = 0, root_blend_ = 0;  // [s]
  bool has_started_ = false, is_behind_ = false;
};

}  // namespace mmm_converter
