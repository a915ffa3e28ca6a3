// SPDX-License-Identifier: MIT
// Where a RobotFollower begins, for the first time or anew.
#include <algorithm>
#include <cmath>

#include "common/math/square.h"
#include "common/retarget/robot_follower.h"

namespace mmm_converter {
namespace {

constexpr int kFirstSteps = 30, kStepsAnew = 15;
// Of a person who jumps from frame to frame: beyond what people do, and what estimates are off.
constexpr double kJumpSpeed = 12, kJumpWay = 0.05;    // [m/s], [m] of the hips
constexpr double kJumpTurning = 30, kJumpTurn = 0.2;  // [rad/s], [rad] of the pelvis
constexpr double kFar = 5;                            // deviations of aims, rms
constexpr double kWorthIt = 0.5;      // of the cost, of a posture that is worth a return
constexpr double kPatience = 0.2;     // [s] far off; twice as long each time it is to no end, until
constexpr double kMostPatience = 5;   // [s]
constexpr double kOtherFloor = 0.04;  // [m] above or below 0, of a floor that is not at 0

}  // namespace

// Of who was not seen before: the lowest point of the feet is on it.
void RobotFollower::FindFloor() {
  double lowest = INFINITY;
  for (std::size_t i = 0; i < 2; ++i) {
    lowest = std::min({lowest, points_[i][0].height_of_level() - human_.heel_heights[i],
                       points_[i][1].height_of_level() - human_.toe_heights[i]});
  }
  if (std::abs(lowest) < kOtherFloor) return;
  for (std::size_t i = 0; i < 2; ++i) {
    points_[i][0].SetLevel(human_.heel_heights[i] + lowest);
    points_[i][1].SetLevel(human_.toe_heights[i] + lowest);
  }
}

void RobotFollower::FitAnew() {
  const int joints = robot_.model.num_joints();
  Bound(INFINITY);
  const Eigen::VectorXd lower = lower_.tail(joints), upper = upper_.tail(joints);
  before_ = posture_;
  const Posture upright = FirstPosture(person_posture_, scale_, robot_, body_);
  if (!has_begun_) {
    posture_ = StartTrajectory(problem_, upright).front();
    return Solve(kFirstSteps, 1 / rate_);
  }
  Posture leaning = upright;
  if (!robot_.model.is_root_fixed()) {
    leaning.orientation =
        Eigen::Quaterniond(person_posture_.R_pelvis * body_.map.R_WA.transpose()) *
        ZeroPosture(robot_.model).orientation;
  }
  constexpr std::size_t kAsBefore = 2;  // of these, with joints as before
  std::array<Posture, 4> starts = {upright, leaning, leaning, upright};
  starts[0].joint_angles = starts[1].joint_angles = posture_.joint_angles;
  starts[2].joint_angles = body_.rest;
  starts[3].joint_angles = 0.7 * body_.rest + 0.15 * (lower.cwiseMax(-3) + upper.cwiseMin(3));
  Posture best = posture_;
  double least = INFINITY;
  for (std::size_t n = 0; n < starts.size(); ++n) {
    posture_ = starts[n];
    posture_.joint_angles = posture_.joint_angles.cwiseMax(lower).cwiseMin(upper);
    Solve(kStepsAnew, 1 / rate_);
    const double cost = equations_.CostOf(0, posture_) / (n < kAsBefore ? 1 : kWorthIt);
    if (!(cost < least)) continue;
    least = cost;
    best = posture_;
  }
  posture_ = best;
}

void RobotFollower::Begin(double time) {
  is_following_ = false;
  const bool is_known = has_begun_;
  for (auto& foot : points_) {
    for (PointWatch& point : foot) point.Forget();
  }
  for (Foot& foot : feet_) {
    foot.stands = false;
    foot.drawn_for = INFINITY;
  }
  raised_for_ = far_for_ = 0;
  is_behind_ = false;
  WatchPerson(time);
  if (!is_known) FindFloor();
  SetAims(1 / rate_);
  FitAnew();
  speed_.setZero(6 + robot_.model.num_joints());
}

bool RobotFollower::HasJumped(const BodyPosture& before, double dt) const {
  const double way = (person_posture_.mid_hip - before.mid_hip).norm();
  const Eigen::AngleAxisd turn(before.R_pelvis.transpose() * person_posture_.R_pelvis);
  return way > kJumpWay + kJumpSpeed * dt || std::abs(turn.angle()) > kJumpTurn + kJumpTurning * dt;
}

bool RobotFollower::IsStuck(double dt) {
  double sum = 0;
  for (std::size_t n = 0; n < person_aims_.size(); ++n) {
    const Aim& aim = problem_.aims[n];
    const Eigen::Isometry3d& X = robot_state_.X_WS(aim.segment);
    const Eigen::Vector3d now = aim.is_direction ? X.linear() * aim.local : X * aim.local;
    sum += aim.weight.col(0).cwiseProduct(aim.target.col(0) - now).squaredNorm();
  }
  const bool is_far = sum > Square(kFar) * static_cast<double>(person_aims_.size());
  far_for_ = is_far ? far_for_ + dt : 0;
  if (!is_far) patience_ = kPatience;
  if (far_for_ < patience_) return false;
  patience_ = std::clamp(2 * patience_, kPatience, kMostPatience);
  far_for_ = 0;
  const Posture now = posture_;
  const double cost = equations_.CostOf(0, posture_);
  is_following_ = false;
  FitAnew();
  if (equations_.CostOf(0, posture_) < kWorthIt * cost) return true;
  posture_ = now;
  is_following_ = true;
  return false;
}

}  // namespace mmm_converter
