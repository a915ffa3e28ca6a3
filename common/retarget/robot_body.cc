// SPDX-License-Identifier: MIT
#include "common/retarget/robot_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

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
constexpr double kLeastSoleSize = 0.01, kMostSoleSize = 1;         // [m]
constexpr double kMostSize = 10;  // [m] of a leg; beyond it the file is in centimetres
using Eigen::Vector3d;

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

void CheckSole(const SoleChoice& choice) {
  if (choice.depth && *choice.depth != 0 &&
      !(*choice.depth >= kLeastSoleHeight && *choice.depth <= kMostSoleHeight)) {
    throw Error(fmt::format(
        "{}: a sole is not {:g} m ({:g} mm) below the ankle; expected are {:g} to {:g} m ({:g} to "
        "{:g} mm), or 0 where the link begins at the sole",
        OptionText(choice.size ? "sole" : "sole-height"), *choice.depth,
        kMillimetres * *choice.depth, kLeastSoleHeight, kMostSoleHeight,
        kMillimetres * kLeastSoleHeight, kMillimetres * kMostSoleHeight));
  }
  if (choice.size &&
      !(choice.size->minCoeff() >= kLeastSoleSize && choice.size->maxCoeff() <= kMostSoleSize)) {
    throw Error(fmt::format(
        "{}: a foot is not {:g} m long and {:g} m wide; expected are {:g} to {:g} m",
        OptionText("sole"), choice.size->x(), choice.size->y(), kLeastSoleSize, kMostSoleSize));
  }
}

}  // namespace

std::string DoubtOf(const Robot& robot, const RobotBody& body) {
  if (body.feet) return (*body.feet)[0].doubt;
  if (robot.model.is_root_fixed()) return "";
  return "the robot has no legs that are used: its base stands where it is, and does not follow "
         "the "
         "person";
}

void PlaceBase(const Robot& robot, RobotBody* body) {
  Posture rest = ZeroPosture(robot.model);
  body->base = rest.position;
  if (body->feet || robot.model.is_root_fixed()) return;
  rest.joint_angles = body->rest;
  const auto X_WS = SegmentPoses(robot.model, rest);
  double lowest = INFINITY;
  for (const ContactShape& shape : robot.shapes) {
    lowest = std::min(lowest, LowestHeight(shape, X_WS[shape.segment]));
  }
  for (const CapsuleBody& one : body->capsules.bodies) {
    for (const BodyCapsule& capsule : one.capsules) {
      for (const Vector3d& end : {capsule.a_S, capsule.b_S}) {
        if (!robot.shapes.empty()) continue;
        lowest = std::min(lowest, (X_WS[one.segment] * end).z() - capsule.radius);
      }
    }
  }
  for (const Robot::Link& link : robot.links) {
    lowest = std::min(lowest, (X_WS[link.segment] * link.X_SL).translation().z());
  }
  body->base.z() -= lowest;
}

BodyMap FindRobotMap(const Robot& robot, const BodyMapChoice& choice) {
  BodyMap map = FindBodyMap(robot.model, choice);
  CheckLoops(robot, map);
  return map;
}

RobotBody FindRobotBody(const Robot& robot, const BodyMapChoice& choice, const SoleChoice& sole) {
  CheckSole(sole);
  RobotBody body;
  body.map = FindRobotMap(robot, choice);
  const auto X_WS = SegmentPoses(robot.model, ZeroPosture(robot.model));
  if (body.map.has_legs()) {
    body.feet = {FindFoot(robot, X_WS, body.map, Side::kLeft, sole),
                 FindFoot(robot, X_WS, body.map, Side::kRight, sole)};
    const LimbMap& leg = *body.map.legs[0];
    const BodyPosture zero = PostureOfBody(body.map, X_WS);
    body.hip_width = (zero.legs[0].proximal - zero.legs[1].proximal).norm();
    body.size = leg.length() + (*body.feet)[0].ankle_height;
  } else {
    body.size = body.map.arms[0]->length();
  }
  if (body.size > kMostSize) {
    throw Error(
        fmt::format("the robot {}: its {} are {:.3g} m long: its file is in centimetres or "
                    "millimetres, and URDF "
                    "and MJCF are in metres; scale its lengths",
                    robot.model.name(), body.feet ? "legs" : "arms", body.size));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (!body.map.arms[i]) continue;
    const int hand = body.map.arms[i]->end;
    body.palms[i] = {hand, X_WS[hand].inverse() * PalmOf(PostureOfBody(body.map, X_WS).arms[i])};
  }
  body.rest = ZeroPosture(robot.model).joint_angles;
  HoldIdleJoints(robot, &body);
  body.capsules = FindCapsules(robot, body.map);
  PlaceBase(robot, &body);
  WatchContacts(robot, &body);
  return body;
}

}  // namespace mmm_converter
