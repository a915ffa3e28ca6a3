// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/live/pose_frame.h"
#include "common/pipeline/robot.h"
#include "common/retarget/follow_figures.h"
#include "common/retarget/guarded_follower.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A robot that follows whom a session tracks: its postures in the place of theirs, and of every
/// frame since somebody was seen first.
class LiveRobot {
 public:
  /// @throws Error where the robot can't be read, or its limbs or soles are not known.
  LiveRobot(const RobotRequest& request, const FollowOptions& options, Warnings* warnings);

  /// @throws Error where the person's model has no legs and arms that are known.
  void Take(const std::shared_ptr<const LiveBody>& person, const PoseFrame& pose);

  // Of the last frame:
  const std::shared_ptr<const LiveBody>& body() const { return body_; }
  const PoseFrame& frame() const { return frame_; }

  /// Of all frames until then.
  RetargetFigures figures() const { return watch_.Figures(); }

  /// Why the soles may be others; empty: nothing.
  const std::string& doubt() const { return doubt_; }

  /// What there is to say since the last call, line by line.
  std::vector<std::string> TakeNews() { return std::exchange(news_, {}); }

 private:
  bool IsSeen(const PoseFrame& pose);
  void Name(std::int64_t number, double time);

  LoadedRobot robot_;
  std::string doubt_;
  FollowOptions options_;
  std::shared_ptr<const LiveBody> person_, body_;
  std::unique_ptr<GuardedFollower> follower_;
  FollowWatch watch_;
  PoseFrame frame_;
  int most_seen_ = 0;             // markers of the person
  double seen_time_ = -INFINITY;  // of the last frame that showed enough of them [s]
  bool is_seen_ = false, is_settled_ = false;
  double back_time_ = 0, assembled_time_ = 0;  // of who was found again, last [s]
  FollowState named_ = FollowState::kTracks;
  bool named_rest_ = false;
  double lost_time_ = 0, name_jump_at_ = -INFINITY;  // [s]
  std::vector<std::string> news_;
};

}  // namespace mmm_converter
