// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/robot_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "MMMConverterS2KF/report/model_json.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

Json TripleJson(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

const char* NameOf(ContactShape::Kind kind) {
  switch (kind) {
    case ContactShape::Kind::kBox:
      return "box";
    case ContactShape::Kind::kSphere:
      return "sphere";
    case ContactShape::Kind::kCapsule:
      return "capsule";
    case ContactShape::Kind::kCylinder:
      return "cylinder";
    case ContactShape::Kind::kEllipsoid:
      return "ellipsoid";
    case ContactShape::Kind::kHull:
      return "hull";
  }
  return "";
}

Json ToJson(const ContactShape& shape) {
  const Eigen::Quaterniond q(shape.X_SG.linear());
  return {{"kind", NameOf(shape.kind)},
          {"segment", shape.segment},
          {"position", TripleJson(shape.X_SG.translation())},
          {"orientation", {q.x(), q.y(), q.z(), q.w()}},
          {"half", TripleJson(shape.half)},
          {"radius", shape.radius},
          {"half_length", shape.half_length}};
}

/// A joint as people look for it.
struct JointPlace {
  std::string group = "neck", side;
  int order = 0;  ///< of its side's in the group
};

void PlaceLimb(const KinematicModel& model, const LimbMap& limb, bool is_leg, Side side,
               std::vector<JointPlace>* places) {
  int counts[3] = {0, 0, 0};
  const char* const names[2][3] = {{"shoulder", "elbow", "wrist"}, {"hip", "knee", "ankle"}};
  int part = 0;
  std::vector<bool> is_below(model.segments().size());
  for (int i = limb.chain.front(); i < static_cast<int>(model.segments().size()); ++i) {
    const Segment& segment = model.segments()[i];
    is_below[i] = i == limb.chain.front() || (segment.parent >= 0 && is_below[segment.parent]);
    if (!is_below[i]) continue;
    const auto of_chain = std::find(limb.chain.begin(), limb.chain.end(), i);
    const auto at = of_chain - limb.chain.begin();
    part = of_chain == limb.chain.end() || at >= limb.beyond ? 2 : at < limb.fold ? 0 : 1;
    if (segment.joint >= 0 && segment.leader < 0) {
      (*places)[segment.joint] = {names[is_leg ? 1 : 0][part], Name(side), counts[part]++};
    }
  }
}

std::vector<JointPlace> PlacesOfJoints(const KinematicModel& model, const BodyMap& map) {
  std::vector<JointPlace> places(model.num_joints());
  for (const int end : {map.pelvis, map.chest}) {
    for (int i = end; i >= 0; i = model.segments()[i].parent) {
      if (model.segments()[i].joint >= 0) places[model.segments()[i].joint].group = "trunk";
    }
  }
  for (const Side side : kSides) {
    if (const auto& leg = map.leg(side)) PlaceLimb(model, *leg, true, side, &places);
    if (const auto& arm = map.arm(side)) PlaceLimb(model, *arm, false, side, &places);
  }
  return places;
}

/// Bones that the segments do not have: feet, and hands without joints.
Json EndsJson(const RobotBody& body) {
  Json ends = Json::array();
  const auto add = [&](int segment, const Vector3d& p_S) {
    ends.push_back({{"segment", segment}, {"position", TripleJson(p_S)}});
  };
  for (std::size_t i = 0; i < 2; ++i) {
    if (body.feet) {
      add((*body.feet)[i].segment, (*body.feet)[i].heel);
      add((*body.feet)[i].segment, (*body.feet)[i].toe);
    }
    const auto& arm = body.map.arms[i];
    if (arm && !arm->has_wrist) add(arm->distal.segment, arm->distal.p_S);
  }
  return ends;
}

}  // namespace

Json MappedModelJson(const KinematicModel& model, const BodyMap& map) {
  std::vector<std::string> parts(model.segments().size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int parent = model.segments()[i].parent;
    if (parent >= 0) parts[i] = parts[parent];
    for (const Side side : kSides) {
      const std::string name = Name(side);
      const auto segment = static_cast<int>(i);
      if (const auto& leg = map.leg(side)) {
        if (leg->chain.front() == segment) parts[i] = name + " leg";
        if (leg->end == segment) parts[i] = name + " foot";
      }
      if (const auto& arm = map.arm(side)) {
        if (arm->chain.front() == segment) parts[i] = name + " arm";
      }
    }
  }
  Json json = ToJson(model);
  json["parts"] = parts;
  return json;
}

Json RobotJson(const Robot& robot, const RobotBody& body) {
  Json json = MappedModelJson(robot.model, body.map);
  json["ends"] = EndsJson(body);
  Json& shapes = json["shapes"] = Json::array();
  for (const ContactShape& shape : robot.shapes) shapes.push_back(ToJson(shape));
  const std::vector<JointPlace> places = PlacesOfJoints(robot.model, body.map);
  for (int j = 0; j < robot.model.num_joints(); ++j) {
    Json& joint = json["joints"][j];
    joint["group"] = places[j].group;
    joint["side"] = places[j].side;
    joint["order"] = places[j].order;
    joint["slides"] = robot.model.joint(j).type == JointType::kSliding;
    const double speed = robot.velocity_limits[j];
    joint["speed"] = std::isfinite(speed) ? Json(speed) : Json();
    for (const char* limit : {"lower", "upper"}) {
      if (!std::isfinite(joint[limit].get<double>())) joint[limit] = nullptr;
    }
  }
  return json;
}

}  // namespace mmm_converter
