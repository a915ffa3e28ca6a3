// SPDX-License-Identifier: MIT
#include "common/model/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "common/model/forward_kinematics.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::array<const char*, 5> kShapeNames = {"box", "sphere", "capsule", "cylinder",
                                                    "ellipsoid"};
constexpr std::array<const char*, 5> kShapesNames = {"boxes", "spheres", "capsules", "cylinders",
                                                     "ellipsoids"};

double Sign(double x) { return (x > 0 ? 1.0 : 0.0) - (x < 0 ? 1.0 : 0.0); }

/// In G, from the origin.
Eigen::Vector3d SupportOf(const ContactShape& shape, const Eigen::Vector3d& d) {
  switch (shape.kind) {
    case ContactShape::Kind::kBox:
      return shape.half.cwiseProduct(d.unaryExpr(&Sign));
    case ContactShape::Kind::kSphere:
      return shape.radius * d.normalized();
    case ContactShape::Kind::kCapsule:
      return shape.radius * d.normalized() +
             shape.half_length * Sign(d.z()) * Eigen::Vector3d::UnitZ();
    case ContactShape::Kind::kCylinder: {
      Eigen::Vector3d across(d.x(), d.y(), 0);
      across.normalize();
      return shape.radius * across + shape.half_length * Sign(d.z()) * Eigen::Vector3d::UnitZ();
    }
    case ContactShape::Kind::kEllipsoid: {
      const Eigen::Vector3d scaled = shape.half.cwiseProduct(d);
      return shape.half.cwiseProduct(scaled.normalized());
    }
  }
  return Eigen::Vector3d::Zero();
}

/// Of a rigid body: how a segment that is fixed to it lies in its root.
Eigen::Isometry3d PoseInRoot(const KinematicModel& model, int segment) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const int root = RigidRoot(model, segment);
  for (; segment != root; segment = model.segments()[segment].parent) {
    X = model.segments()[segment].X_PF * X;
  }
  return X;
}

std::vector<Eigen::Isometry3d> PosesAtRest(const KinematicModel& model) {
  Posture posture = ZeroPosture(model);
  if (!model.is_root_fixed()) posture.joint_angles = RestAngles(model);
  return SegmentPoses(model, posture);
}

bool IsAtOrBelow(const KinematicModel& model, int segment, int root) {
  while (segment != root && segment >= 0) segment = model.segments()[segment].parent;
  return segment == root;
}

/// The name of the body that is the foot; of several the one nearest to the root.
std::string BodyName(const Robot& robot, int root) {
  for (const Robot::Link& link : robot.links) {
    if (link.segment == root && !link.name.empty()) return link.name;
  }
  return robot.model.segments()[root].name;
}

/// Those of toes, too, as they are at rest.
void AddShapes(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS, Sole* sole) {
  std::map<ContactShape::Kind, int> counts;
  for (const ContactShape& shape : robot.shapes) {
    if (!IsAtOrBelow(robot.model, shape.segment, sole->segment)) continue;
    ContactShape& added = sole->shapes.emplace_back(shape);
    added.X_SG = X_WS[sole->segment].inverse() * X_WS[shape.segment] * shape.X_SG;
    added.segment = sole->segment;
    ++counts[shape.kind];
  }
  std::vector<std::string> said;
  for (const auto& [kind, count] : counts) {
    const auto i = static_cast<std::size_t>(kind);
    said.push_back(fmt::format("{} {}", count, count == 1 ? kShapeNames[i] : kShapesNames[i]));
  }
  sole->said = JoinNames(said, " and ") + " of " + BodyName(robot, sole->segment);
}

void AddPoint(const Eigen::Vector3d& p_SP, Sole* sole) {
  ContactShape& point = sole->shapes.emplace_back();
  point.segment = sole->segment;
  point.X_SG.translation() = p_SP;
}

template <typename Place>
void AddNamed(const Robot& robot, const std::vector<Place>& places, Eigen::Isometry3d Place::*pose,
              const char* what, Sole* sole) {
  std::vector<std::string> names;
  for (const Place& place : places) {
    if (RigidRoot(robot.model, place.segment) != sole->segment ||
        ToLower(place.name).find("sole") == std::string::npos) {
      continue;
    }
    AddPoint(PoseInRoot(robot.model, place.segment) * (place.*pose).translation(), sole);
    names.push_back(place.name);
  }
  if (!names.empty()) sole->said = fmt::format("{} {}", what, JoinNames(names, " and "));
}

std::string WhyNone(const Robot& robot, int root) {
  const auto meshes =
      std::count_if(robot.mesh_segments.begin(), robot.mesh_segments.end(),
                    [&](int segment) { return RigidRoot(robot.model, segment) == root; });
  const std::string body = BodyName(robot, root);
  if (meshes == 0) return fmt::format("{} has no shape that touches the ground", body);
  return fmt::format("{} has {} {}, which {} not read, and no box, sphere, capsule or cylinder",
                     body, meshes, meshes == 1 ? "mesh" : "meshes", meshes == 1 ? "is" : "are");
}

void MeasureDepth(Sole* sole) {
  sole->depth = -std::numeric_limits<double>::infinity();
  for (const ContactShape& shape : sole->shapes) {
    sole->depth = std::max(sole->depth, sole->down_S.dot(SupportPoint(shape, sole->down_S)));
  }
}

}  // namespace

Eigen::Vector3d SupportPoint(const ContactShape& shape, const Eigen::Vector3d& direction_S) {
  const Eigen::Vector3d direction_G = shape.X_SG.linear().transpose() * direction_S;
  return shape.X_SG * SupportOf(shape, direction_G);
}

double LowestHeight(const ContactShape& shape, const Eigen::Isometry3d& X_WS) {
  const Eigen::Vector3d down_S = -X_WS.linear().row(2).transpose();
  return (X_WS * SupportPoint(shape, down_S)).z();
}

int RigidRoot(const KinematicModel& model, int segment) {
  while (model.segments()[segment].joint < 0 && model.segments()[segment].parent >= 0) {
    segment = model.segments()[segment].parent;
  }
  return segment;
}

std::optional<Sole> FindSole(const Robot& robot, int segment, std::optional<double> given_depth,
                             std::string* reason) {
  Sole sole;
  sole.segment = RigidRoot(robot.model, segment);
  const std::vector<Eigen::Isometry3d> X_WS = PosesAtRest(robot.model);
  sole.down_S = -X_WS[sole.segment].linear().row(2).transpose();
  if (given_depth) {
    sole.source = Sole::Source::kGiven;
    sole.said = fmt::format("{:.0f} mm, as given", 1e3 * *given_depth);
    AddPoint(*given_depth * sole.down_S, &sole);
  } else {
    AddShapes(robot, X_WS, &sole);
  }
  if (sole.shapes.empty()) {
    sole.source = Sole::Source::kNamed;
    AddNamed(robot, robot.sites, &Robot::Site::X_SP, "site", &sole);
  }
  if (sole.shapes.empty()) AddNamed(robot, robot.links, &Robot::Link::X_SL, "link", &sole);
  if (sole.shapes.empty()) {
    if (reason != nullptr) *reason = WhyNone(robot, sole.segment);
    return std::nullopt;
  }
  MeasureDepth(&sole);
  return sole;
}

}  // namespace mmm_converter
