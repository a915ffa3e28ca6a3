// SPDX-License-Identifier: MIT
#include "common/retarget/self_contact.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/model/forward_kinematics.h"
#include "common/retarget/held_joints.h"
#include "common/retarget/retarget_targets.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kClear = 0.01;      // [m] above the floor
constexpr double kArmsApart = 0.15;  // [rad]
constexpr FootDeviations kStanding = {0.006, 0.03, 0.006, 0.1};

/// As long as the robot: all that counts are directions.
BodyPosture StandingPerson(const RobotBody& body) {
  BodyPosture person;
  person.R_pelvis = person.R_chest = Eigen::Matrix3d::Identity();
  person.mid_hip = {0, 0, body.size};
  for (std::size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    LimbPosture& leg = person.legs[i];
    leg.R_upper = leg.R_lower = leg.R_end = Eigen::Matrix3d::Identity();
    leg.distal = {0, 0.5 * side * body.hip_width, 0};
    leg.proximal = leg.distal + body.size * Vector3d::UnitZ();
    leg.middle = 0.5 * (leg.proximal + leg.distal);
    LimbPosture& arm = person.arms[i];
    arm = leg;
    arm.R_upper = arm.R_lower = arm.R_end =
        Eigen::AngleAxisd(side * kArmsApart, Vector3d::UnitX()).toRotationMatrix();
  }
  return person;
}

bool IsFootOrAnkle(const BodyMap& map, int segment) {
  return std::any_of(map.legs.begin(), map.legs.end(), [&](const std::optional<LimbMap>& leg) {
    return leg && std::find(leg->chain.begin() + leg->beyond, leg->chain.end(), segment) !=
                      leg->chain.end();
  });
}

/// An arm of whose forearm and hand no size is known ends at its wrist.
void AddBareWrists(const Robot& robot, RobotBody* body) {
  for (const std::optional<LimbMap>& arm : body->map.arms) {
    if (!arm) continue;
    const auto is_known = [&](const FloorBall& ball) {
      return std::find(arm->chain.begin() + arm->fold, arm->chain.end(), ball.segment) !=
             arm->chain.end();
    };
    if (std::any_of(body->balls.begin(), body->balls.end(), is_known)) continue;
    if (RigidRoot(robot.model, arm->distal.segment) != arm->distal.segment) continue;
    body->balls.push_back({arm->distal.segment, arm->distal.p_S, 0});
  }
}

/// What is on the floor where the robot stands is no part that could get there.
void FindBalls(const Robot& robot, const Posture& standing, RobotBody* body) {
  const auto X_WS = SegmentPoses(robot.model, standing);
  for (const CapsuleBody& one : body->capsules.bodies) {
    if (IsFootOrAnkle(body->map, one.segment)) continue;
    for (const BodyCapsule& capsule : one.capsules) {
      for (const Vector3d& end : {capsule.a_S, capsule.b_S}) {
        if ((X_WS[one.segment] * end).z() - capsule.radius < kClear) continue;
        const bool is_known = !body->balls.empty() && body->balls.back().p_S == end &&
                              body->balls.back().segment == one.segment;
        if (!is_known) body->balls.push_back({one.segment, end, capsule.radius});
      }
    }
  }
  AddBareWrists(robot, body);
}

std::string NameOfBody(const RobotCapsules& capsules, int segment) {
  for (const CapsuleBody& one : capsules.bodies) {
    if (one.segment == segment) return one.name;
  }
  return "a wrist";
}

}  // namespace

Posture StandingRobot(const Robot& robot, const RobotBody& body) {
  Retargeted standing;
  standing.human.rate = 1;
  standing.human.bodies = {StandingPerson(body)};
  for (std::size_t i = 0; i < 2; ++i) {
    standing.human.R_feet[i] = {Eigen::Matrix3d::Identity()};
    standing.rests[i] = {{true}, {true}, {{0, 1}}};
  }
  const FootTracks feet = ScaledFeet(standing, body);
  const TrajectoryProblem problem = MakeProblem(standing, robot, body, feet, kStanding);
  return StartTrajectory(problem, FirstPosture(standing.human.bodies[0], 1, robot, body)).front();
}

void WatchContacts(const Robot& robot, RobotBody* body) {
  RobotCapsules& capsules = body->capsules;
  capsules.pairs.clear();
  body->balls.clear();
  Posture zero = ZeroPosture(robot.model), standing = StandingRobot(robot, *body);
  for (Posture* posture : {&zero, &standing}) PutHeldJoints(*body, posture);
  PairBodies(robot.model, body->map, &capsules);
  for (const Posture& posture : {zero, standing}) {
    PlacedCapsules placed;
    PlaceCapsules(capsules, SegmentPoses(robot.model, posture), &placed);
    std::erase_if(capsules.pairs, [&](const std::pair<int, int>& pair) {
      return FindTouch(capsules, placed, pair, 0).depth > 0;
    });
  }
  if (body->feet) FindBalls(robot, standing, body);
}

void MeasureBodyDepth(const PoseTrajectory& motion, const RobotBody& body,
                      const PosesOverTime& X_WS, RetargetFigures* figures) {
  for (std::size_t k = 0; k < X_WS.size(); ++k) {
    for (const FloorBall& ball : body.balls) {
      const double depth = ball.radius - (X_WS[k][ball.segment] * ball.p_S).z();
      if (depth <= figures->body_depth) continue;
      figures->body_depth = depth;
      figures->body_depth_time = motion.time(static_cast<int>(k));
      figures->deepest_body = NameOfBody(body.capsules, ball.segment);
    }
  }
}

void MeasureSelfContact(const PoseTrajectory& motion, const RobotCapsules& capsules,
                        const PosesOverTime& X_WS, RetargetFigures* figures) {
  std::vector<TouchFigures> touches(capsules.pairs.size());
  PlacedCapsules placed;
  for (std::size_t k = 0; k < X_WS.size(); ++k) {
    PlaceCapsules(capsules, X_WS[k], &placed);
    for (std::size_t n = 0; n < touches.size(); ++n) {
      const double depth = FindTouch(capsules, placed, capsules.pairs[n], 0).depth;
      if (depth <= 0) continue;
      touches[n].share += 1 / static_cast<double>(X_WS.size());
      if (depth <= touches[n].depth) continue;
      touches[n].depth = depth;
      touches[n].time = motion.time(static_cast<int>(k));
    }
  }
  for (std::size_t n = 0; n < touches.size(); ++n) {
    if (touches[n].depth <= 0) continue;
    const auto [i, j] = capsules.pairs[n];
    const bool is_nearer = capsules.bodies[i].part < capsules.bodies[j].part;  // to the trunk
    const CapsuleBody& first = capsules.bodies[is_nearer ? j : i];
    const CapsuleBody& second = capsules.bodies[is_nearer ? i : j];
    touches[n].first = first.name;
    touches[n].second = second.name;
    touches[n].is_by_mass = first.is_by_mass || second.is_by_mass;
    figures->touches.push_back(std::move(touches[n]));
  }
  std::stable_sort(figures->touches.begin(), figures->touches.end(),
                   [](const auto& a, const auto& b) { return a.depth > b.depth; });
}

}  // namespace mmm_converter
