// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "common/retarget/belt.h"
#include "common/retarget/motion_governor.h"
#include "common/retarget/robot_follower.h"

namespace mmm_converter {

/// What a robot does that follows a person who may leave, return and jump.
enum class FollowState {
  kTracks,   ///< the person, within its limits
  kHolds,    ///< the person is lost: it stops, and after a while goes to its posture at rest
  kReturns,  ///< to the person, from where it was
};

/// A RobotFollower whose robot never goes faster than its limits, with a posture for every frame
/// since the person was seen first. The belt of a treadmill is the floor.
class GuardedFollower {
 public:
  /// As RobotFollower.
  GuardedFollower(std::shared_ptr<const KinematicModel> person, const Robot& robot,
                  const RobotBody& body, double rate, const FollowOptions& options,
                  const GuardedFollower* before = nullptr);

  /// Postures are valid until the next call.
  const Posture& Follow(const Posture& person, double time);
  /// The person is not seen in this frame. Only where has_begun().
  const Posture& Hold(double time);

  bool has_begun() const { return governor_.has_started(); }
  double scale() const { return follower_.scale(); }
  // Of the last frame; poses and the person on the belt, which stands:
  FollowState state() const { return state_; }
  bool rests() const { return state_ == FollowState::kHolds && held_for_ >= rest_after_; }
  const BodyPosture& person() const { return follower_.person(); }
  const std::vector<Eigen::Isometry3d>& X_WS() const { return robot_state_.poses(); }
  bool stands(std::size_t foot) const {
    return state_ != FollowState::kHolds && follower_.stands(foot);
  }

 private:
  double StepTo(double time);
  const Posture& HoldFor(double dt);
  void FindRest();
  const Posture& Finish(double dt);

  const Robot& robot_;
  const RobotBody& body_;
  double rate_, rest_after_;
  RobotFollower follower_;
  MotionGovernor governor_;
  SegmentJacobian robot_state_;
  FollowState state_ = FollowState::kTracks;
  double held_for_ = 0;  // [s]
  double time_ = 0;      // of the last frame [s]
  BeltWatch belt_;
  Eigen::Vector3d belt_way_ = Eigen::Vector3d::Zero();  // that it went [m]
  Posture rest_, posture_, on_belt_;
};

/// A whole motion followed frame by frame, as a stream's would be.
Retargeted FollowMotion(const KinematicModel& human_model, const PoseTrajectory& motion,
                        const Robot& robot, const RobotBody& body);

}  // namespace mmm_converter
