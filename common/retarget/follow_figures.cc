// SPDX-License-Identifier: MIT
#include "common/retarget/follow_figures.h"

#include <algorithm>
#include <cmath>

#include "common/math/square.h"
#include "common/retarget/foot_figures.h"

namespace mmm_converter {

FollowWatch::FollowWatch(const Robot& robot, const RobotBody& body)
    : robot_(robot),
      body_(body),
      angles_(Eigen::VectorXd::Zero(robot.model.num_joints())),
      at_limit_(angles_),
      at_speed_(angles_),
      speeds_(angles_),
      lowest_(Eigen::VectorXd::Constant(angles_.size(), INFINITY)),
      highest_(-lowest_),
      accelerations_(angles_),
      is_held_(robot.model.num_joints()) {
  for (const int joint : body.held) is_held_[joint] = true;
  for (std::string& name : NamesOfLimbs(body.map)) limbs_.emplace_back().name = std::move(name);
}

void FollowWatch::Take(const Frame& frame) {
  const double dt = has_before_ ? frame.time - before_ : 0;
  ++frames_;
  TakeState(frame.state, dt);
  TakeFeet(frame, dt);
  TakeJoints(frame.posture, dt);
  if (frame.state != FollowState::kHolds) TakeLimbs(frame);
  has_before_ = true;
  before_ = frame.time;
  last_dt_ = std::max(0.0, dt);
}

void FollowWatch::TakeState(FollowState state, double dt) {
  FollowedFigures& followed = figures_.followed;
  followed.seconds += std::max(0.0, dt);
  if (state == FollowState::kHolds) followed.held += std::max(0.0, dt);
  if (state != state_ && state == FollowState::kHolds) ++followed.holds;
  if (state != state_ && state == FollowState::kReturns) {
    ++(state_ == FollowState::kHolds ? followed.returns : followed.jumps);
  }
  state_ = state;
}

void FollowWatch::TakeFeet(const Frame& frame, double dt) {
  for (std::size_t i = 0; i < 2 && body_.feet; ++i) {
    const RobotFoot& foot = (*body_.feet)[i];
    const Eigen::Isometry3d& X = frame.X_WS[foot.segment];
    const double lowest = LowestOf(foot, X);
    if (-lowest > figures_.penetration) {
      figures_.penetration = -lowest;
      figures_.penetration_time = frame.time;
    }
    if (frame.stands[i]) {
      ++contacts_;
      height_ += lowest;
      if (dt > 0 && stands_[i]) {
        ++pairs_;
        if (WayOf(foot, feet_[i], X) > kSlideSpeed * dt) ++slides_;
      }
    }
    stands_[i] = frame.stands[i];
    feet_[i] = X;
  }
}

void FollowWatch::TakeJoints(const Posture& posture, double dt) {
  for (int j = 0; j < robot_.model.num_joints(); ++j) {
    const double q = posture.joint_angles[j];
    const double speed = dt > 0 ? std::abs(q - angles_[j]) / dt : 0;
    const JointState state = StateOf(robot_, j, q, speed);
    figures_.position_breaks += state.is_beyond ? 1 : 0;
    figures_.velocity_breaks += state.is_too_fast ? 1 : 0;
    lowest_[j] = std::min(lowest_[j], q);
    highest_[j] = std::max(highest_[j], q);
    const double velocity = dt > 0 ? (q - angles_[j]) / dt : 0;
    if (dt > 0 && last_dt_ > 0) accelerations_[j] += Square((velocity - speeds_[j]) / dt);
    speeds_[j] = velocity;
    if (dt > 0) figures_.largest_jump = std::max(figures_.largest_jump, speed * dt);
    if (is_held_[j]) continue;
    at_limit_[j] += state.is_at_limit ? 1 : 0;
    at_speed_[j] += state.is_at_speed ? 1 : 0;
  }
  angles_ = posture.joint_angles;
  if (dt > 0 && last_dt_ > 0) ++changes_;
  if (dt > 0) {
    figures_.root_speed = std::max(figures_.root_speed, (posture.position - place_).norm() / dt);
  }
  place_ = posture.position;
}

void FollowWatch::TakeLimbs(const Frame& frame) {
  const bool by_chest = !body_.feet;
  const LimbDirections person = DirectionsOf(body_.map, frame.person, by_chest);
  const LimbDirections robot =
      DirectionsOf(body_.map, PostureOfBody(body_.map, frame.X_WS), by_chest);
  if (!person.is_known || !robot.is_known) return;
  ++known_;
  for (std::size_t n = 0; n < robot.count; ++n) {
    const double error = AngleBetween(person.limbs[n], robot.limbs[n]);
    limbs_[n].mean += error;
    if (error <= limbs_[n].most) continue;
    limbs_[n].most = error;
    limbs_[n].most_time = frame.time;
  }
}

RetargetFigures FollowWatch::Figures() const {
  RetargetFigures figures = figures_;
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : NAN; };
  figures.num_frames = static_cast<int>(frames_);
  figures.contact_share = share(contacts_, 2 * frames_);
  figures.slide = share(slides_, pairs_);
  figures.floating = share(height_, contacts_);
  figures.path = figures.toe_slide = figures.direction95 = NAN;
  const Eigen::ArrayXd moves = ((highest_ - lowest_).array() > kMoves).cast<double>();
  figures.acceleration =
      std::sqrt((moves * accelerations_.array()).sum() / std::max(1.0, moves.sum() * changes_));
  double sum = 0;
  for (LimbFigures limb : limbs_) {
    limb.mean = share(limb.mean, known_);
    sum += limb.mean;
    figures.limbs.push_back(std::move(limb));
  }
  figures.direction = share(sum, static_cast<double>(limbs_.size()));
  for (int j = 0; j < robot_.model.num_joints(); ++j) {
    AddJointFigures(
        {robot_.model.joint(j).name, share(at_limit_[j], frames_), share(at_speed_[j], frames_)},
        &figures);
  }
  return figures;
}

}  // namespace mmm_converter
