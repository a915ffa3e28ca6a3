// SPDX-License-Identifier: MIT
#include "common/pipeline/live/live_robot.h"

#include <chrono>
#include <numeric>

namespace mmm_converter {

LiveRobot::LiveRobot(const RobotRequest& request, Warnings* warnings)
    : robot_(ReadRobot(request, warnings)), watch_(robot_.robot, robot_.body) {}

void LiveRobot::Take(const std::shared_ptr<const LiveBody>& person, const PoseFrame& pose) {
  if (person != person_) {
    // A calibration changes the person only: the robot stays as it is, and goes on.
    follower_ = std::make_unique<RobotFollower>(person->setup.model, robot_.robot, robot_.body,
                                                person->rate, follower_.get());
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
  frame_.is_tracking = pose.is_tracking;
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
  if (pose.is_tracking) {
    estimate.posture = follower_->Follow(pose.estimate.posture, pose.time);
    watch_.Take({follower_->person(),
                 estimate.posture,
                 follower_->X_WS(),
                 {follower_->stands(0), follower_->stands(1)},
                 pose.time});
  } else {
    follower_->Interrupt();
    watch_.Interrupt();
  }
  frame_.tracked = std::chrono::steady_clock::now();
}

}  // namespace mmm_converter
