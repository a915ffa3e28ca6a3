// SPDX-License-Identifier: MIT
#include "common/retarget/robot_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <vector>

#include "common/math/rotation.h"
#include "common/math/square.h"
#include "common/model/forward_kinematics.h"
#include "common/retarget/body_posture.h"
#include "common/retarget/held_joints.h"
#include "common/retarget/held_objects.h"
#include "common/retarget/self_contact.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kLeastSoleHeight = 0.005, kMostSoleHeight = 0.5;  // [m]
using Eigen::Vector3d;

constexpr double kTilts[] = {0.3, 1};  // of directions in which the sole's ends are the lowest
constexpr int kAround = 8;             // of these
constexpr double kLeastSpread = 0.05, kMostSpread = 1;  // [rad] of a leg at the zero pose
constexpr double kSamePlace = 1e-4;                     // [m]

void AddBall(int segment, const Vector3d& p_S, double radius, std::vector<FloorBall>* balls) {
  const bool is_known = std::any_of(balls->begin(), balls->end(), [&](const FloorBall& ball) {
    return (ball.p_S - p_S).norm() < kSamePlace && ball.radius == radius;
  });
  if (!is_known) balls->push_back({segment, p_S, radius});
}

/// Points of a shape that may be its lowest ones as the foot tilts.
void AddBalls(const RobotFoot& foot, const ContactShape& shape, std::vector<FloorBall>* balls) {
  const Eigen::Isometry3d& X = shape.X_SG;
  if (shape.kind == ContactShape::Kind::kSphere || shape.kind == ContactShape::Kind::kCapsule) {
    for (const double end : {-shape.half_length, shape.half_length}) {
      const bool is_sphere = shape.kind == ContactShape::Kind::kSphere;
      AddBall(foot.segment, X * Vector3d(0, 0, is_sphere ? 0 : end), shape.radius, balls);
    }
    return;
  }
  for (const double tilt : kTilts) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kAround;
      const Vector3d down(tilt * std::cos(angle), tilt * std::sin(angle), -1);
      AddBall(foot.segment, SupportPoint(shape, foot.R_FA * down.normalized()), 0, balls);
    }
  }
}

/// The farthest point of the foot in a direction of its flat axes.
Vector3d FarthestOf(const RobotFoot& foot, const Vector3d& direction_A) {
  const Vector3d direction = foot.R_FA * direction_A;
  Vector3d farthest = Vector3d::Zero();
  double most = -INFINITY;
  for (const ContactShape& shape : foot.shapes) {
    const Vector3d p = SupportPoint(shape, direction);
    if (p.dot(direction) > most) farthest = p;
    most = std::max(most, p.dot(direction));
  }
  return farthest;
}

/// Turns legs that are spread at the zero pose about the way they face until the knee's axis is
/// level: then feet are flat.
Eigen::Matrix3d LevelKnee(const std::vector<Eigen::Isometry3d>& X_WS, const BodyMap& map,
                          const LimbMap& leg) {
  const Vector3d left =
      map.R_WA.transpose() * X_WS[leg.lower.segment].linear() * leg.lower.R_SL.col(1);
  const double tilt = std::atan2(left.z(), left.y());
  if (std::abs(tilt) < kLeastSpread || std::abs(tilt) > kMostSpread) {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::AngleAxisd(-tilt, map.R_WA.col(0)).toRotationMatrix();
}

RobotFoot MakeFoot(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS,
                   const BodyMap& map, Side side, std::optional<double> sole_height) {
  const LimbMap& leg = *map.leg(side);
  std::string reason;
  const auto sole = FindSole(robot, leg.end, sole_height, &reason);
  if (!sole) {
    throw Error(
        fmt::format("the robot {}: where the sole of its {} foot is, its file does not "
                    "say ({}); give the height of {} above the sole",
                    robot.model.name(), Name(side), reason, robot.model.segments()[leg.end].name));
  }
  RobotFoot foot;
  foot.segment = sole->segment;
  foot.said = sole->said;
  foot.rolls = static_cast<int>(leg.chain.size()) - leg.fold > 2;
  foot.shapes = sole->shapes;
  foot.R_FA = (LevelKnee(X_WS, map, leg) * X_WS[foot.segment].linear()).transpose() * map.R_WA;
  for (const ContactShape& shape : foot.shapes) AddBalls(foot, shape, &foot.balls);
  const Eigen::Matrix3d R_AF = foot.R_FA.transpose();
  const Vector3d lowest = R_AF * FarthestOf(foot, -Vector3d::UnitZ());
  const double right = (R_AF * FarthestOf(foot, {0, -1, -3})).y();
  const double left = (R_AF * FarthestOf(foot, {0, 1, -3})).y();
  const Vector3d ankle_W = X_WS[leg.distal.segment] * leg.distal.p_S;
  const Vector3d ankle = R_AF * (X_WS[foot.segment].inverse() * ankle_W);
  foot.width = left - right;
  const double middle = 0.5 * (right + left);
  const auto place = [&](double x) {
    return Vector3d(foot.R_FA * Vector3d(x, middle, lowest.z()));
  };
  foot.sole = place(ankle.x());
  foot.heel = place((R_AF * FarthestOf(foot, {-1, 0, -3})).x());
  foot.toe = place((R_AF * FarthestOf(foot, {1, 0, -3})).x());
  foot.ankle_height = ankle.z() - lowest.z();
  return foot;
}

/// By pitch and roll: the edge that bears keeps its direction on the floor. With the roll last
/// that is the edge of heel or toes, with the pitch last a side's; on a corner one becomes the
/// other.
Eigen::Matrix3d TurnOf(const RobotFoot& foot, double pitch, double roll) {
  const Eigen::AngleAxisd of_roll(roll, Vector3d::UnitX()), of_pitch(pitch, Vector3d::UnitY());
  Eigen::Matrix3d roll_last = (of_roll * of_pitch).toRotationMatrix();
  const double end =
      (foot.toe - foot.heel).norm() * std::abs(std::sin(pitch));  // [m] that it rises
  const double side = foot.width * std::abs(std::sin(roll));
  if (side == 0) return roll_last;
  const double on_side = 1 / (1 + Square(Square(end / side)));
  const Eigen::Quaterniond between((of_pitch * of_roll).toRotationMatrix() * roll_last.transpose());
  return Exp(on_side * Log(between)) * roll_last;
}

/// Joints of the limb that are in the loop which the tie closes.
std::vector<int> JointsInLoop(const KinematicModel& model, const LimbMap& limb,
                              const std::array<int, 2>& tie) {
  std::set<int> once;  // above one of both, not above both
  for (const int end : tie) {
    for (int at = end; at >= 0; at = model.segments()[at].parent) {
      if (!once.insert(at).second) once.erase(at);
    }
  }
  std::vector<int> joints;
  std::copy_if(limb.chain.begin(), limb.chain.end(), std::back_inserter(joints),
               [&](int segment) { return once.count(segment) > 0; });
  return joints;
}

/// A knee that a rod ties to another joint of its leg would move where the leg can't.
void CheckLoops(const Robot& robot, const BodyMap& map) {
  for (const auto* limbs : {&map.legs, &map.arms}) {
    for (const auto& limb : *limbs) {
      for (const std::array<int, 2>& tie : robot.ties) {
        if (!limb) continue;
        const std::vector<int> joints = JointsInLoop(robot.model, *limb, tie);
        const bool has_fold = std::count(joints.begin(), joints.end(), limb->chain[limb->fold]) > 0;
        if (!has_fold || joints.size() < 2) continue;
        throw Error(fmt::format(
            "the robot {}: its file ties {} and {} together (<equality>), and limbs with such "
            "loops are not moved; give a file in which the limb is one chain, or a map without it",
            robot.model.name(), robot.model.segments()[joints[0]].name,
            robot.model.segments()[joints[1]].name));
      }
    }
  }
}

}  // namespace

double LowestOf(const RobotFoot& foot, const Eigen::Isometry3d& X_WF) {
  double lowest = INFINITY;
  for (const ContactShape& shape : foot.shapes)
    lowest = std::min(lowest, LowestHeight(shape, X_WF));
  return lowest;
}

Eigen::Isometry3d StandingFoot(const RobotFoot& foot, const Eigen::Vector2d& place, double yaw,
                               double pitch, double roll) {
  const Eigen::Matrix3d R_WY = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d R_YA = TurnOf(foot, pitch, roll);
  const Eigen::Matrix3d R_AF = foot.R_FA.transpose();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = R_WY * R_YA * R_AF;
  Vector3d bears = foot.sole;
  double lowest = INFINITY;
  for (const FloorBall& ball : foot.balls) {
    const double height = X.linear().row(2).dot(ball.p_S) - ball.radius;
    if (height < lowest - kSamePlace) bears = ball.p_S - ball.radius * foot.R_FA.col(2);
    lowest = std::min(lowest, height);
  }
  const Vector3d bears_W = Vector3d(place.x(), place.y(), 0) + R_WY * R_AF * (bears - foot.sole);
  X.translation() = bears_W - X.linear() * bears;
  X.translation().z() -= LowestOf(foot, X);
  return X;
}

BodyMap FindRobotMap(const Robot& robot, const BodyMapChoice& choice) {
  BodyMap map = FindBodyMap(robot.model, choice);
  CheckLoops(robot, map);
  return map;
}

RobotBody FindRobotBody(const Robot& robot, const BodyMapChoice& choice,
                        std::optional<double> sole_height) {
  if (sole_height && *sole_height != 0 &&
      !(*sole_height >= kLeastSoleHeight && *sole_height <= kMostSoleHeight)) {
    throw Error(fmt::format(
        "{}: a sole is not {:g} m ({:g} mm) below the ankle; expected are {:g} to {:g} m ({:g} to "
        "{:g} mm), or 0 where the link begins at the sole",
        OptionText("sole-height"), *sole_height, kMillimetres * *sole_height, kLeastSoleHeight,
        kMostSoleHeight, kMillimetres * kLeastSoleHeight, kMillimetres * kMostSoleHeight));
  }
  RobotBody body;
  body.map = FindRobotMap(robot, choice);
  const auto X_WS = SegmentPoses(robot.model, ZeroPosture(robot.model));
  if (body.map.has_legs()) {
    body.feet = {MakeFoot(robot, X_WS, body.map, Side::kLeft, sole_height),
                 MakeFoot(robot, X_WS, body.map, Side::kRight, sole_height)};
    const LimbMap& leg = *body.map.legs[0];
    const BodyPosture zero = PostureOfBody(body.map, X_WS);
    body.hip_width = (zero.legs[0].proximal - zero.legs[1].proximal).norm();
    body.size = leg.upper.length + leg.lower.length + (*body.feet)[0].ankle_height;
  } else {
    body.size = body.map.arms[0]->upper.length + body.map.arms[0]->lower.length;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!body.map.arms[i]) continue;
    const int hand = body.map.arms[i]->end;
    body.palms[i] = {hand, X_WS[hand].inverse() * PalmOf(PostureOfBody(body.map, X_WS).arms[i])};
  }
  body.rest = ZeroPosture(robot.model).joint_angles;
  HoldIdleJoints(robot, &body);
  body.capsules = FindCapsules(robot, body.map);
  WatchContacts(robot, &body);
  return body;
}

}  // namespace mmm_converter
