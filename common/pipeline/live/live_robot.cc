// SPDX-License-Identifier: MIT
#include "common/pipeline/live/live_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>

namespace mmm_converter {
namespace {

constexpr double kPredicted = 0.05;  // [s] without enough markers, in which a prediction is near
// [s] that who is found again is to be the same from frame to frame; then a robot returns, or
// later.
constexpr double kSettles = 0.02, kSettlesAtMost = 0.15;
constexpr int kEnough = 3;       // of the most that were seen, the part that shows the person
constexpr double kNextJump = 1;  // [s] until another one is worth a line

}  // namespace

LiveRobot::LiveRobot(const RobotRequest& request, const FollowOptions& options, Warnings* warnings)
    : robot_(ReadRobot(request, warnings)),
      doubt_(DoubtOf(robot_.robot, robot_.body)),
      options_(options),
      watch_(robot_.robot, robot_.body) {}

bool LiveRobot::IsSeen(const PoseFrame& pose) {
  if (!pose.is_tracking) return is_seen_ = is_settled_ = false;
  const int seen = pose.estimate.markers_seen - pose.estimate.markers_wrong;
  most_seen_ = std::max(most_seen_, seen);
  if (seen >= std::max(kFewestMarkers, most_seen_ / kEnough)) seen_time_ = pose.time;
  if (std::abs(pose.time - seen_time_) > kPredicted) return is_seen_ = is_settled_ = false;
  if (!is_seen_) back_time_ = pose.time;
  if (!is_seen_ || pose.estimate.reassembled) assembled_time_ = pose.time;
  is_seen_ = true;
  is_settled_ |= !follower_->has_begun() || pose.time - assembled_time_ > kSettles ||
                 pose.time - back_time_ > kSettlesAtMost;
  return is_settled_;
}

void LiveRobot::Name(std::int64_t number, double time) {
  const FollowState state = follower_->state();
  const auto say = [&](const std::string& text) {
    news_.push_back(fmt::format("frame {}: {}", number, text));
  };
  if (state == FollowState::kHolds && named_ != state) {
    say("the person is lost; the robot holds");
    lost_time_ = time;
  } else if (state == FollowState::kHolds && follower_->rests() && !named_rest_) {
    say("the robot goes to its posture at rest");
  } else if (state == FollowState::kReturns && named_ == FollowState::kHolds) {
    say(fmt::format("the robot returns to the person, after {:.1f} s", time - lost_time_));
  } else if (state == FollowState::kReturns && named_ != state && time > name_jump_at_) {
    say("the person jumped, or was far from the robot for long; it returns");
    name_jump_at_ = time + kNextJump;
  }
  named_ = state;
  named_rest_ = follower_->rests();
}

void LiveRobot::Take(const std::shared_ptr<const LiveBody>& person, const PoseFrame& pose) {
  if (person != person_) {
    // A calibration changes the person only: the robot stays as it is, and goes on.
    follower_ = std::make_unique<GuardedFollower>(person->setup.model, robot_.robot, robot_.body,
                                                  person->rate, options_, follower_.get());
    most_seen_ = 0;
    if (!body_ || body_->rate != person->rate) {
      auto body = std::make_shared<LiveBody>();
      body->name = robot_.robot.model.name();
      body->setup.model = std::make_shared<KinematicModel>(robot_.robot.model);
      body->setup.joints.resize(static_cast<std::size_t>(robot_.robot.model.num_joints()));
      std::iota(body->setup.joints.begin(), body->setup.joints.end(), 0);
      body->rate = person->rate;
      body->count = person->count;
      body_ = std::move(body);
    }
    person_ = person;
  }
  frame_.number = pose.number;
  frame_.time = pose.time;
  frame_.received = pose.received;
  frame_.counts = pose.counts;
  frame_.stage = pose.stage;
  frame_.progress = pose.progress;
  frame_.dropped = pose.dropped;
  frame_.points.resize(3, 0);
  FrameEstimate& estimate = frame_.estimate;
  estimate.markers_seen = pose.estimate.markers_seen;
  estimate.markers_downweighted = pose.estimate.markers_downweighted;
  estimate.markers_wrong = pose.estimate.markers_wrong;
  estimate.nis = pose.estimate.nis;
  estimate.reassembled = pose.estimate.reassembled;
  estimate.converged = pose.estimate.converged;
  const bool is_seen = IsSeen(pose);
  frame_.is_held = !is_seen;
  if (is_seen || follower_->has_begun()) {
    estimate.posture =
        is_seen ? follower_->Follow(pose.estimate.posture, pose.time) : follower_->Hold(pose.time);
  }
  frame_.is_tracking = follower_->has_begun();
  if (frame_.is_tracking) {
    watch_.Take(*follower_, estimate.posture, pose.time);
    Name(pose.number, pose.time);
  }
  if (frame_.is_held && frame_.is_tracking) frame_.stage = "the robot holds";
  frame_.tracked = std::chrono::steady_clock::now();
}

}  // namespace mmm_converter
