// SPDX-License-Identifier: MIT
#include "common/retarget/held_joints.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/retarget/self_contact.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kRounding = 1e-6;  // of an angle at its limit

void MarkAbove(const KinematicModel& model, int segment, std::vector<bool>* joints) {
  for (int at = segment; at >= 0; at = model.segments()[at].parent) {
    if (model.segments()[at].joint >= 0) (*joints)[model.segments()[at].joint] = true;
  }
}

std::vector<bool> JointsOfLegs(const KinematicModel& model, const RobotBody& body) {
  std::vector<bool> joints(model.num_joints());
  for (std::size_t i = 0; i < 2 && body.feet; ++i) {
    for (const int segment : body.map.legs[i]->chain) {
      if (model.segments()[segment].joint >= 0) joints[model.segments()[segment].joint] = true;
    }
    MarkAbove(model, (*body.feet)[i].segment, &joints);
  }
  return joints;
}

void HoldOne(int joint, double angle, RobotBody* body) {
  body->rest[joint] = angle;
  if (std::count(body->held.begin(), body->held.end(), joint) == 0) body->held.push_back(joint);
}

/// "left_hand_*", 30
struct HeldPattern {
  std::string name;
  double number = 0;
};

HeldPattern ParsePattern(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto number =
      equals == std::string::npos ? std::nullopt : ParseDouble(text.substr(equals + 1));
  if (equals == 0 || !number || !std::isfinite(*number)) {
    throw Error(fmt::format("{}: \"{}\" is no JOINT=DEGREES; for instance left_hand_*=30,neck=0",
                            OptionText("hold"), text));
  }
  return {text.substr(0, equals), *number};
}

[[noreturn]] void ThrowUnknown(const KinematicModel& model, const HeldPattern& pattern) {
  for (const Segment& segment : model.segments()) {
    if (fnmatch(pattern.name.c_str(), segment.name.c_str(), 0) != 0 || segment.parent < 0) continue;
    throw Error(
        fmt::format("{}: {} does not move: it is fixed, has equal limits "
                    "or follows another joint",
                    OptionText("hold"), segment.name));
  }
  std::vector<std::string> names;
  names.reserve(model.num_joints());
  for (int j = 0; j < model.num_joints(); ++j) names.push_back(model.joint(j).name);
  const std::string near = ClosestName(pattern.name, names);
  throw Error(fmt::format("{}: the robot {} has no joint \"{}\"{}; it has {}", OptionText("hold"),
                          model.name(), pattern.name,
                          near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                          FirstNames(names)));
}

void CheckAllows(const Segment& joint, double angle, const HeldPattern& pattern) {
  if (angle >= joint.lower - kRounding && angle <= joint.upper + kRounding) return;
  const bool slides = joint.type == JointType::kSliding;
  const double unit = slides ? kMillimetres : kDegrees;
  throw Error(fmt::format("{}: {}={:g} is beyond what the joint {} allows, {:.4g} to {:.4g} {}",
                          OptionText("hold"), pattern.name, pattern.number, joint.name,
                          unit * joint.lower, unit * joint.upper, slides ? "mm" : "degrees"));
}

void HoldPattern(const KinematicModel& model, const std::vector<bool>& legs,
                 const HeldPattern& pattern, RobotBody* body) {
  bool is_known = false;
  for (int j = 0; j < model.num_joints(); ++j) {
    const Segment& joint = model.joint(j);
    if (fnmatch(pattern.name.c_str(), joint.name.c_str(), 0) != 0) continue;
    is_known = true;
    if (legs[j]) {
      throw Error(fmt::format("{}: {} is a joint of a leg, which the feet need", OptionText("hold"),
                              joint.name));
    }
    const double angle =
        pattern.number / (joint.type == JointType::kSliding ? kMillimetres : kDegrees);
    CheckAllows(joint, angle, pattern);
    HoldOne(j, std::clamp(angle, joint.lower, joint.upper), body);
  }
  if (!is_known) ThrowUnknown(model, pattern);
}

}  // namespace

void HoldIdleJoints(const Robot& robot, RobotBody* body) {
  const KinematicModel& model = robot.model;
  std::vector<bool> moves(model.num_joints());
  MarkAbove(model, body->map.pelvis, &moves);
  MarkAbove(model, body->map.chest, &moves);
  for (std::size_t i = 0; i < 2; ++i) {
    if (body->map.legs[i]) MarkAbove(model, body->map.legs[i]->end, &moves);
    if (body->map.arms[i]) MarkAbove(model, body->map.arms[i]->end, &moves);
    if (body->feet) MarkAbove(model, (*body->feet)[i].segment, &moves);
  }
  for (int j = 0; j < model.num_joints(); ++j) {
    if (!moves[j]) HoldOne(j, body->rest[j], body);
  }
}

void HoldJoints(const Robot& robot, const std::string& angles, RobotBody* body) {
  const std::vector<bool> legs = JointsOfLegs(robot.model, *body);
  if (angles.empty()) return;
  for (const std::string& pattern : Split(angles, ',')) {
    HoldPattern(robot.model, legs, ParsePattern(pattern), body);
  }
  PlaceBase(robot, body);
  WatchContacts(robot, body);
}

bool BendFeet(const RobotBody& body, KinematicModel* model) {
  ModelDescription bent = DescriptionOf(*model);
  bool are_bent = false;
  for (const int joint : body.held) {
    const int segment = model->joint_segment(joint);
    for (std::size_t i = 0; i < 2 && body.feet; ++i) {
      if (!model->IsBelow(segment, (*body.feet)[i].segment)) continue;
      bent.segments[static_cast<std::size_t>(segment)].rest = body.rest[joint];
      are_bent = true;
    }
  }
  if (are_bent) *model = KinematicModel(std::move(bent));
  return are_bent;
}

void PutHeldJoints(const RobotBody& body, Posture* posture) {
  for (const int joint : body.held) posture->joint_angles[joint] = body.rest[joint];
}

}  // namespace mmm_converter
