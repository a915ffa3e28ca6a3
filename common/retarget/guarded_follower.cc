// SPDX-License-Identifier: MIT
#include "common/retarget/guarded_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/motion/marker_synthesis.h"

namespace mmm_converter {
namespace {

constexpr double kShortestReturn = 0.3, kLongestReturn = 0.6;  // [s]
constexpr double kRestAfter = 2;                               // [s]
constexpr double kToRest = 2;                                  // [s], at least
constexpr double kStoodStill = 0.1, kStoodFrames = 2.5;  // [s] without a frame: a robot stands
constexpr double kLiftAbove = 5e-4;                      // [m] of depth in the floor

bool IsFinite(const Posture& posture) {
  return posture.position.allFinite() && posture.orientation.coeffs().allFinite() &&
         posture.joint_angles.allFinite();
}

}  // namespace

GuardedFollower::GuardedFollower(std::shared_ptr<const KinematicModel> person, const Robot& robot,
                                 const RobotBody& body, double rate, const FollowOptions& options,
                                 const GuardedFollower* before)
    : robot_(robot),
      body_(body),
      rate_(rate > 0 ? rate : 100),
      rest_after_(options.rest_after.value_or(kRestAfter)),
      follower_(std::move(person), robot, body, rate, before ? &before->follower_ : nullptr),
      governor_(before != nullptr ? before->governor_ : MotionGovernor(LimitsOf(robot, options))),
      robot_state_(robot.model) {
  if (before == nullptr) return;
  state_ = before->state_;
  held_for_ = before->held_for_;
  time_ = before->time_;
  rest_ = before->rest_;
  belt_ = before->belt_;
  belt_way_ = before->belt_way_;
}

/// A robot that got no frame for a while stands, and goes on as from one frame to the next.
double GuardedFollower::StepTo(double time) {
  const double dt = time - time_;
  time_ = time;
  if (dt > 0 && dt <= std::max(kStoodStill, kStoodFrames / rate_)) return dt;
  governor_.Stop();
  if (dt > 0 && state_ == FollowState::kHolds) held_for_ += dt;
  follower_.Interrupt();
  return 1 / rate_;
}

const Posture& GuardedFollower::Finish(double dt) {
  const bool had_one = posture_.joint_angles.size() > 0;
  const Eigen::Vector3d before = posture_.position - follower_.scale() * belt_way_;
  posture_ = governor_.posture();
  if (body_.feet && !robot_.model.is_root_fixed()) {
    posture_.position.z() += std::max(0.0, follower_.DepthOf(posture_) - kLiftAbove);
    const Eigen::Vector3d way = posture_.position - before;
    const double most = governor_.fastest() * dt;
    if (had_one && way.norm() > most) posture_.position = before + most * way.normalized();
  }
  robot_state_.Compute(posture_);
  posture_.position += follower_.scale() * belt_way_;
  return posture_;
}

const Posture& GuardedFollower::Follow(const Posture& person, double time) {
  const double dt = StepTo(time);
  if (!IsFinite(person)) return HoldFor(dt);
  belt_way_ += dt * belt_.velocity();
  on_belt_ = person;
  on_belt_.position -= belt_way_;
  const Posture& goal = follower_.Follow(on_belt_, time);
  follower_.is_anew() ? belt_.Interrupt()
                      : belt_.Take(follower_.points(), follower_.person().mid_hip, dt);
  if (!IsFinite(goal)) return HoldFor(dt);
  if (!has_begun()) {
    governor_.Start(goal);
    state_ = FollowState::kTracks;
  } else if (follower_.is_anew()) {
    governor_.Blend(goal, kShortestReturn, kLongestReturn);
    state_ = FollowState::kReturns;
  }
  if (follower_.has_joined()) governor_.Join();
  governor_.Go(goal, dt);
  if (!governor_.is_blending()) {
    state_ = FollowState::kTracks;
    if (governor_.is_behind()) governor_.Correct(follower_.StandFirm(governor_, dt), dt);
  }
  return Finish(dt);
}

/// Where it stands, upright.
void GuardedFollower::FindRest() {
  const Posture& now = governor_.posture();
  rest_ = ZeroPosture(robot_.model);
  rest_.joint_angles = body_.rest;
  if (robot_.model.is_root_fixed()) return;
  const Eigen::Matrix3d turn = (now.orientation * rest_.orientation.conjugate()).toRotationMatrix();
  const double yaw = std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
  rest_.orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * rest_.orientation;
  rest_.position.head<2>() = now.position.head<2>();
  rest_.position.z() = now.position.z();
  if (!body_.feet) return;
  robot_state_.Compute(rest_);
  double lowest = std::numeric_limits<double>::infinity();
  for (const RobotFoot& foot : *body_.feet) {
    lowest = std::min(lowest, LowestOf(foot, robot_state_.X_WS(foot.segment)));
  }
  rest_.position.z() -= lowest;
}

const Posture& GuardedFollower::Hold(double time) { return HoldFor(StepTo(time)); }

const Posture& GuardedFollower::HoldFor(double dt) {
  if (!has_begun()) {
    follower_.Interrupt();
    posture_ = ZeroPosture(robot_.model);
    return posture_;
  }
  if (state_ != FollowState::kHolds) held_for_ = 0;
  state_ = FollowState::kHolds;
  follower_.Interrupt();
  const bool rested = held_for_ >= rest_after_;
  held_for_ += dt;
  if (held_for_ < rest_after_) {
    governor_.Brake(dt);
    return Finish(dt);
  }
  if (!rested) {
    FindRest();
    governor_.Blend(rest_, kToRest, std::numeric_limits<double>::infinity());
  }
  governor_.Go(rest_, dt);
  return Finish(dt);
}

Retargeted FollowMotion(const KinematicModel& human_model, const PoseTrajectory& motion,
                        const Robot& robot, const RobotBody& body) {
  Retargeted result = DescribePerson(human_model, motion, robot, body);
  GuardedFollower follower(std::make_shared<KinematicModel>(human_model), robot, body, motion.rate,
                           {});
  for (int k = 0; k < motion.num_frames(); ++k) {
    result.motion.postures.push_back(
        follower.Follow(ModelPosture(human_model, motion, k), motion.time(k)));
  }
  result.keeps_limits = true;
  return result;
}

}  // namespace mmm_converter
