// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/pose_frame.h"
#include "common/pipeline/robot.h"
#include "common/retarget/follow_figures.h"
#include "common/retarget/robot_follower.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A robot that follows whom a session tracks: its postures in the place of theirs.
class LiveRobot {
 public:
  /// @throws Error where the robot can't be read, or its limbs or soles are not known.
  LiveRobot(const RobotRequest& request, Warnings* warnings);

  /// @throws Error where the person's model has no legs and arms that are known.
  void Take(const std::shared_ptr<const LiveBody>& person, const PoseFrame& pose);

  // Of the last frame:
  const std::shared_ptr<const LiveBody>& body() const { return body_; }
  const PoseFrame& frame() const { return frame_; }

  /// Of all frames until then.
  RetargetFigures figures() const { return watch_.Figures(); }

 private:
  LoadedRobot robot_;
  std::shared_ptr<const LiveBody> person_, body_;
  std::unique_ptr<RobotFollower> follower_;
  FollowWatch watch_;
  PoseFrame frame_;
};

}  // namespace mmm_converter
