// SPDX-License-Identifier: MIT
#include "common/retarget/motion_governor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/math/rotation.h"
#include "common/math/square.h"
#include "common/retarget/foot_turns.h"

namespace mmm_converter {
namespace {

// Of joints whose file states no speed: what knees of humanoids are built for.
constexpr double kJointSpeed = 20, kSlidingSpeed = 1;  // [rad/s], [m/s]
constexpr double kSpeedsUpIn = 0.1;                    // [s] to the speed of a joint that slides
// [rad/s^2] With 150 feet that walk (G1, H1, T1 on walking2) slide twice as often, or four times;
// with 250 accelerations on an acrobat's motion (85_02) are a tenth higher.
constexpr double kRise = 200;
constexpr double kRootSpeed = 6, kRootRise = 100;         // [m/s], [m/s^2]
constexpr double kTurningSpeed = 20, kTurningRise = 250;  // [rad/s], [rad/s^2]
// Of an acceleration, with which what nears its target slows down: with 0.7 it overshoots, and
// turns back as hard.
constexpr double kBraking = 0.25;
constexpr double kLimitBraking = 0.85;  // before the end of a joint: frames need an eighth more
constexpr double kStopping = 0.5;       // and what has no target
constexpr double kBlendSpeed = 0.7, kBlendRise = 0.5;          // of the limits, for a blend
constexpr double kQuinticSpeed = 1.875, kQuinticRise = 5.774;  // the most of Fading, over its time
constexpr double kBelowLimit = 1 - 1e-9;
constexpr double kBehind = 1e-6;  // [m, rad]: rounding

void Advance(const Eigen::VectorXd& difference, Posture* posture) {
  posture->position += difference.head<3>();
  posture->orientation = (posture->orientation * Exp(difference.segment<3>(3))).normalized();
  posture->joint_angles += difference.tail(posture->joint_angles.size());
}

}  // namespace

void DifferenceOf(const Posture& from, const Posture& to, Eigen::VectorXd* difference) {
  difference->head<3>() = to.position - from.position;
  difference->segment<3>(3) = Log(from.orientation.conjugate() * to.orientation);
  difference->tail(from.joint_angles.size()) = to.joint_angles - from.joint_angles;
}

double StoppingSpeed(double way, double rise, double dt) {
  const double half = 0.5 * rise * dt;
  return std::min(way / dt, std::sqrt(half * half + 2 * rise * way) - half);
}

double SpeedTowards(double target_speed, double missing, double rise, double dt) {
  const double nearing = StoppingSpeed(std::abs(missing), kBraking * rise, dt);
  return target_speed + std::copysign(nearing, missing);
}

MotionLimits LimitsOf(const Robot& robot, const FollowOptions& options) {
  const int joints = robot.model.num_joints();
  MotionLimits limits;
  limits.speed.resize(6 + joints);
  limits.acceleration.resize(6 + joints);
  limits.lower.resize(joints);
  limits.upper.resize(joints);
  limits.speed.head<3>().setConstant(kBelowLimit * options.root_speed.value_or(kRootSpeed));
  limits.acceleration.head<3>().setConstant(kRootRise);
  limits.speed.segment<3>(3).setConstant(kTurningSpeed);
  limits.acceleration.segment<3>(3).setConstant(kTurningRise);
  for (int j = 0; j < joints; ++j) {
    const Segment& joint = robot.model.joint(j);
    limits.lower[j] = joint.lower;
    limits.upper[j] = joint.upper;
    double speed = robot.velocity_limits[j];
    const bool slides = joint.type == JointType::kSliding;
    if (std::isinf(speed)) speed = slides ? kSlidingSpeed : kJointSpeed;
    double rise = slides ? speed / kSpeedsUpIn : kRise;
    if (!slides) {
      speed = std::min(speed, options.joint_speed.value_or(speed));
      rise = options.joint_acceleration.value_or(rise);
    }
    limits.speed[6 + j] = speed * kBelowLimit;
    limits.acceleration[6 + j] = rise;
  }
  return limits;
}

MotionGovernor::MotionGovernor(MotionLimits limits) : limits_(std::move(limits)) {
  const Eigen::Index size = limits_.speed.size();
  for (Eigen::VectorXd* one :
       {&speed_, &wanted_, &target_speed_, &missing_, &least_, &most_, &off_, &off_speed_}) {
    one->setZero(size);
  }
}

void MotionGovernor::Start(const Posture& posture) {
  posture_ = before_ = target_before_ = target_ = posture;
  elapsed_ = joint_blend_ = root_blend_ = 0;
  speed_.setZero();
  has_started_ = true;
}

double MotionGovernor::BlendTime(Eigen::Index begin, Eigen::Index end) const {
  double time = 0;
  for (Eigen::Index i = begin; i < end; ++i) {
    const double way = std::abs(off_[i]);
    time = std::max({time, kQuinticSpeed * way / (kBlendSpeed * limits_.speed[i]),
                     std::sqrt(kQuinticRise * way / (kBlendRise * limits_.acceleration[i]))});
  }
  return time;
}

void MotionGovernor::Blend(const Posture& target, double shortest, double longest) {
  DifferenceOf(target, posture_, &off_);
  off_speed_ = speed_;
  joint_blend_ = std::clamp(BlendTime(3, off_.size()), shortest, longest);
  root_blend_ = std::max(joint_blend_, BlendTime(0, 3));
  elapsed_ = 0;
  target_before_ = posture_;
}

void MotionGovernor::Go(const Posture& target, double dt) {
  target_ = target;
  if (is_blending()) {
    elapsed_ += dt;
    for (Eigen::Index i = 0; i < off_.size(); ++i) {
      const double time = i < 3 ? root_blend_ : joint_blend_, t = elapsed_ / time;
      missing_[i] = t < 1 ? Fading(off_[i], off_speed_[i] * time, t) : 0;
    }
    Advance(missing_, &target_);
  }
  DifferenceOf(target_before_, target_, &target_speed_);
  target_speed_ /= dt;
  DifferenceOf(posture_, target_before_, &missing_);
  for (Eigen::Index i = 0; i < missing_.size(); ++i) {
    wanted_[i] = SpeedTowards(target_speed_[i], missing_[i], limits_.acceleration[i], dt);
  }
  std::swap(target_before_, target_);
  Move(dt);
  DifferenceOf(posture_, target_before_, &missing_);
  is_behind_ = missing_.cwiseAbs().maxCoeff() > kBehind;
}

void MotionGovernor::Correct(const Posture& posture, double dt) {
  posture_ = posture;
  DifferenceOf(before_, posture_, &speed_);
  speed_ /= dt;
}

void MotionGovernor::Brake(double dt) {
  for (Eigen::Index i = 0; i < speed_.size(); ++i) {
    const double most = kStopping * limits_.acceleration[i] * dt;
    wanted_[i] = speed_[i] - std::clamp(speed_[i], -most, most);
  }
  Move(dt);
  target_before_ = posture_;
}

void MotionGovernor::Move(double dt) {
  before_ = posture_;
  for (Eigen::Index i = 0; i < speed_.size(); ++i) {
    const double rise = limits_.acceleration[i] * dt, fastest = limits_.speed[i];
    double least = std::clamp(speed_[i] - rise, -fastest, fastest);
    double most = std::clamp(speed_[i] + rise, -fastest, fastest);
    if (i >= 6) {
      const double q = posture_.joint_angles[i - 6];
      const double braking = kLimitBraking * limits_.acceleration[i];
      const double above = std::max(0.0, limits_.upper[i - 6] - q);
      const double below = std::max(0.0, q - limits_.lower[i - 6]);
      const double down = -StoppingSpeed(below, braking, dt);
      const double up = StoppingSpeed(above, braking, dt);
      least = std::clamp(least, down, up);
      most = std::clamp(most, down, up);
    }
    speed_[i] = std::clamp(wanted_[i], least, most);
    least_[i] = least * dt;
    most_[i] = most * dt;
  }
  for (const Eigen::Index begin : {0, 3}) {
    const double fast = speed_.segment<3>(begin).norm() / limits_.speed[begin];
    if (fast > 1) speed_.segment<3>(begin) /= fast;
  }
  wanted_ = speed_ * dt;
  Advance(wanted_, &posture_);
  posture_.joint_angles = posture_.joint_angles.cwiseMax(limits_.lower).cwiseMin(limits_.upper);
}

}  // namespace mmm_converter
