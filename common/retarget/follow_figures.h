// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/retarget/guarded_follower.h"
#include "common/retarget/limb_directions.h"
#include "common/retarget/retarget_figures.h"

namespace mmm_converter {

/// Counts what a robot does while it follows, frame by frame, as RetargetFigures have it: contacts
/// are those that were seen then. Allocates nothing after it is made.
class FollowWatch {
 public:
  /// Both stay valid.
  FollowWatch(const Robot& robot, const RobotBody& body);

  struct Frame {
    const BodyPosture& person;
    const Posture& posture;
    const std::vector<Eigen::Isometry3d>& X_WS;
    std::array<bool, 2> stands;
    FollowState state;
    double time;  ///< [s]
  };
  void Take(const Frame& frame);
  void Take(const GuardedFollower& follower, const Posture& posture, double time) {
    Take({follower.person(),
          posture,
          follower.X_WS(),
          {follower.stands(0), follower.stands(1)},
          follower.state(),
          time});
  }

  /// Slide, depth, floating, limits, limbs' directions, accelerations and what the person did; no
  /// percentiles, and nothing over time.
  RetargetFigures Figures() const;

 private:
  void TakeFeet(const Frame& frame, double dt);
  void TakeJoints(const Posture& posture, double dt);
  void TakeState(FollowState state, double dt);
  void TakeLimbs(const Frame& frame);

  const Robot& robot_;
  const RobotBody& body_;
  bool has_before_ = false;
  double before_ = 0;  ///< [s]
  std::array<Eigen::Isometry3d, 2> feet_;
  std::array<bool, 2> stands_ = {};
  double last_dt_ = 0;  ///< [s]; 0: none
  FollowState state_ = FollowState::kTracks;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();  ///< of the root
  Eigen::VectorXd angles_, at_limit_, at_speed_;     ///< the last; frames
  Eigen::VectorXd speeds_, lowest_, highest_;        ///< the last; of all frames
  Eigen::VectorXd accelerations_;                    ///< sums of squares
  std::vector<bool> is_held_;
  std::vector<LimbFigures> limbs_;  ///< mean: the sum
  double frames_ = 0, changes_ = 0, contacts_ = 0, pairs_ = 0, slides_ = 0, height_ = 0, known_ = 0;
  RetargetFigures figures_;
};

}  // namespace mmm_converter
