// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <memory>
#include <vector>

#include "common/retarget/contact_watch.h"
#include "common/retarget/foot_turns.h"
#include "common/retarget/motion_governor.h"
#include "common/retarget/retarget_targets.h"
#include "common/retarget/trajectory_window.h"

namespace mmm_converter {

/// A robot that follows a person frame by frame, each by the frames until then alone: aims as
/// RetargetMotion's, contacts by PointWatch. A foot stays where the robot had it as the person's
/// touched the ground, and turns there only with a person who turns on the spot. It begins anew,
/// wherever it was, where the person jumps or it is far from the person for long.
class RobotFollower {
 public:
  /// Robot and body stay valid. before: whose robot goes on from its joints; null: none. @throws
  /// Error where the person's model is not known.
  RobotFollower(std::shared_ptr<const KinematicModel> person, const Robot& robot,
                const RobotBody& body, double rate, const RobotFollower* before = nullptr);

  /// time: of the frame [s]. The posture is valid until the next call. Allocates in the first
  /// two frames, where it begins anew, and where a part touches the floor or another one for the
  /// first time.
  const Posture& Follow(const Posture& person, double time);

  /// Of a robot that could not get there in this frame: where it gets instead, so that feet that
  /// stand stay where they are. They stand where the robot has them then, and it goes on from there
  /// as soon as one stands. Valid until the next call.
  const Posture& StandFirm(const MotionGovernor& robot, double dt);
  /// The last posture goes on from where the robot is.
  bool has_joined() const { return has_joined_; }

  /// The next frame begins anew.
  void Interrupt() { is_following_ = false; }

  double scale() const { return scale_; }
  /// Of the lowest point of feet or trunk below the floor [m].
  double DepthOf(const Posture& posture) { return equations_.DepthOf(posture); }
  // Of the last frame:
  const BodyPosture& person() const { return person_posture_; }
  const std::vector<Eigen::Isometry3d>& X_WS() const { return robot_state_.poses(); }
  bool is_anew() const { return is_anew_; }
  /// Heels and toes of the person.
  const std::array<std::array<PointWatch, 2>, 2>& points() const { return points_; }
  bool stands(std::size_t foot) const { return feet_[foot].stands; }

 private:
  /// A value that follows another without overshoot (critically damped).
  struct Follower {
    double value = 0, speed = 0;
    void Go(double to, double dt);
  };
  struct Foot {
    bool stands = false;
    Eigen::Vector2d place;  ///< of the flat sole
    double yaw = 0;
    double turned = 0;  ///< of the person's foot where the robot's is turned as it is [rad]
    Follower pitch, roll, height;
    Eigen::Isometry3d aim, aim_before;  ///< of the last frame and the one before
    Eigen::Isometry3d scaled;           ///< where the person's foot put it in the last frame
    FootDifference draw, draw_slope;
    std::array<double, 3> last = {};  ///< pitch, roll and height of the robot's, the frame before
    double drawn_for = 0;             ///< [s] since it left the ground; beyond its end: no draw
  };

  void Begin(double time);
  /// From several postures: the nearest counts.
  void FitAnew();
  bool HasJumped(const BodyPosture& before, double dt) const;
  /// Too far from the person for too long.
  bool IsStuck(double dt);
  void WatchPerson(double time);
  void FindFloor();
  void MoveFloor(double by);
  void MoveLevels(double dt);
  double Floor() const;
  void AimFeet(double dt);
  void Touch(std::size_t foot);
  void Stand(std::size_t foot, double pitch, double dt);
  double YawOfPerson(std::size_t foot) const;
  void TurnWithPerson(std::size_t foot);
  void Leave(std::size_t foot, const Eigen::Isometry3d& scaled, double dt);
  void SetAims(double dt);
  /// Joints to their limits, and to a way from where they are [rad, m].
  void Bound(double way);
  /// Adds what draws the posture to where its speeds lead.
  void AddPrior(double dt);
  void Solve(int iterations, double dt);
  /// A step of H_ and b_, within bounds.
  void Step();
  std::array<double, 3> AnglesOfFoot(std::size_t foot) const;
  void FindPlace();
  void FindSpeed(double dt);
  /// With what lags behind.
  void Exchange();
  void HoldFeet(const MotionGovernor& robot);
  bool HoldAtBounds();
  void Advance(double part);

  std::shared_ptr<const KinematicModel> person_model_;
  const Robot& robot_;
  const RobotBody& body_;
  double rate_;
  HumanBody human_;
  double scale_;
  SegmentJacobian person_;
  BodyPosture person_posture_;
  std::array<Eigen::Matrix3d, 2> R_feet_;
  std::array<std::array<PointWatch, 2>, 2> points_;  // of each foot heel and toe
  double raised_for_ = 0;                            // [s] all points
  std::vector<PersonAim> person_aims_;
  TrajectoryProblem problem_;   // one frame: the person's aims, then three of each foot
  TrajectoryProblem standing_;  // these three of the feet that stand
  AimEquations equations_, standing_equations_;
  SegmentJacobian robot_state_;
  std::vector<FloorContact> contacts_;
  std::array<Foot, 2> feet_;
  Posture posture_, before_;
  Posture other_posture_, other_before_;  // of the robot where it lags behind
  Eigen::VectorXd speed_, other_speed_;   // of the tangent vector
  /// Of a posture: place, turn since the frame before, joints.
  Eigen::VectorXd place_, lower_, upper_, reached_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd b_, step_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double time_ = 0, last_dt_ = 0;      // of the last frame [s]
  double far_for_ = 0, patience_ = 0;  // [s]
  bool has_begun_ = false, is_following_ = false, is_anew_ = false;
  bool is_behind_ = false, has_joined_ = false;
};

}  // namespace mmm_converter
