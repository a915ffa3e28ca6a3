// SPDX-License-Identifier: MIT
#include "common/model/robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "common/model/forward_kinematics.h"
#include "common/support/advice.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::array<const char*, 6> kShapeNames = {"box",      "sphere",    "capsule",
                                                    "cylinder", "ellipsoid", "mesh"};
constexpr std::array<const char*, 6> kShapesNames = {"boxes",     "spheres",    "capsules",
                                                     "cylinders", "ellipsoids", "meshes"};
constexpr double kDeeper = 0.002;  // [m], of a foot below the floor that a verdict tells

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
    case ContactShape::Kind::kHull:
      return *std::max_element(shape.points.begin(), shape.points.end(),
                               [&](const auto& a, const auto& b) { return a.dot(d) < b.dot(d); });
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

/// In the axes of the sole's segment, as they are at rest.
void AddShape(const std::vector<Eigen::Isometry3d>& X_WS, const ContactShape& shape, Sole* sole) {
  ContactShape& added = sole->shapes.emplace_back(shape);
  added.X_SG = X_WS[sole->segment].inverse() * X_WS[shape.segment] * shape.X_SG;
  added.segment = sole->segment;
}

/// Those of a rigid body that were read: what touches, else all.
std::vector<const RobotMesh*> MeshesOf(const Robot& robot, int body) {
  std::vector<const RobotMesh*> meshes;
  for (const bool touches : {true, false}) {
    for (const RobotMesh& mesh : robot.meshes) {
      if (mesh.touches != touches || mesh.hull.empty()) continue;
      if (RigidRoot(robot.model, mesh.segment) == body) meshes.push_back(&mesh);
    }
    if (!meshes.empty()) break;
  }
  return meshes;
}

bool AddShapes(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS, int body,
               Sole* sole) {
  const std::size_t before = sole->shapes.size();
  for (const ContactShape& shape : robot.shapes) {
    if (RigidRoot(robot.model, shape.segment) == body) AddShape(X_WS, shape, sole);
  }
  return sole->shapes.size() > before;
}

bool AddMeshes(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS, int body,
               Sole* sole) {
  const std::vector<const RobotMesh*> meshes = MeshesOf(robot, body);
  for (const RobotMesh* mesh : meshes) {
    ContactShape hull;
    hull.kind = ContactShape::Kind::kHull;
    hull.segment = mesh->segment;
    hull.points = mesh->hull;
    AddShape(X_WS, hull, sole);
  }
  return !meshes.empty();
}

std::string Describe(const Robot& robot, const Sole& sole) {
  std::map<ContactShape::Kind, int> counts;
  for (const ContactShape& shape : sole.shapes) ++counts[shape.kind];
  std::vector<std::string> said;
  for (const auto& [kind, count] : counts) {
    const auto i = static_cast<std::size_t>(kind);
    said.push_back(fmt::format("{} {}", count, count == 1 ? kShapeNames[i] : kShapesNames[i]));
  }
  return JoinNames(said, " and ") + " of " + BodyName(robot, sole.segment);
}

/// Of the foot and of toes below it, each body by itself.
void AddBodies(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS,
               SoleChoice::Take take, Sole* sole) {
  for (int body = sole->segment; body < static_cast<int>(X_WS.size()); ++body) {
    if (RigidRoot(robot.model, body) != body) continue;
    if (!IsAtOrBelow(robot.model, body, sole->segment)) continue;
    const bool takes_meshes = take == SoleChoice::Take::kMeshes;
    const bool has =
        takes_meshes ? AddMeshes(robot, X_WS, body, sole) : AddShapes(robot, X_WS, body, sole);
    if (has) {
      if (takes_meshes) sole->source = Sole::Source::kMeshes;
      continue;
    }
    if (takes_meshes) {
      AddShapes(robot, X_WS, body, sole);
    } else if (take == SoleChoice::Take::kAny && AddMeshes(robot, X_WS, body, sole)) {
      sole->source = Sole::Source::kMeshes;
    }
  }
  if (!sole->shapes.empty()) sole->said = Describe(robot, *sole);
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
  const auto meshes = std::count_if(
      robot.meshes.begin(), robot.meshes.end(),
      [&](const RobotMesh& mesh) { return RigidRoot(robot.model, mesh.segment) == root; });
  const std::string body = BodyName(robot, root);
  if (meshes == 0) return fmt::format("{} has no shape that touches the ground", body);
  return fmt::format("{} has {} {}, which {} not read, and no box, sphere, capsule or cylinder",
                     body, meshes, meshes == 1 ? "mesh" : "meshes", meshes == 1 ? "is" : "are");
}

double DepthOf(const Sole& sole) {
  double depth = -std::numeric_limits<double>::infinity();
  for (const ContactShape& shape : sole.shapes) {
    depth = std::max(depth, sole.down_S.dot(SupportPoint(shape, sole.down_S)));
  }
  return depth;
}

/// Shapes for simulators may end above what was built.
void CompareWithMeshes(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS, Sole* sole) {
  Sole of_meshes;
  of_meshes.segment = sole->segment;
  of_meshes.down_S = sole->down_S;
  AddBodies(robot, X_WS, SoleChoice::Take::kMeshes, &of_meshes);
  const double deeper = DepthOf(of_meshes) - sole->depth;
  if (!(deeper > kDeeper)) return;
  sole->doubt = fmt::format(
      "the sole is {}, and {} end{} {:.1f} mm lower; {} \"meshes\" or \"shapes\" says which counts",
      sole->said, of_meshes.said, of_meshes.shapes.size() == 1 ? "s" : "", 1e3 * deeper,
      OptionText("sole"));
}

void TakeGiven(const SoleChoice& choice, Sole* sole) {
  sole->source = Sole::Source::kGiven;
  sole->said = fmt::format("{:.0f} mm, as given", 1e3 * *choice.depth);
  if (choice.size) {
    sole->said = fmt::format("{:.0f} mm long, {:.0f} wide and {:.0f} below, as given",
                             1e3 * choice.size->x(), 1e3 * choice.size->y(), 1e3 * *choice.depth);
    sole->doubt = "the sole is as given, and nothing in the robot's file confirms it";
  }
  AddPoint(*choice.depth * sole->down_S, sole);
}

void TakeNamed(const Robot& robot, Sole* sole) {
  sole->source = Sole::Source::kNamed;
  AddNamed(robot, robot.sites, &Robot::Site::X_SP, "site", sole);
  if (sole->shapes.empty()) AddNamed(robot, robot.links, &Robot::Link::X_SL, "link", sole);
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

std::optional<Sole> FindSole(const Robot& robot, int segment, const SoleChoice& choice,
                             std::string* reason) {
  Sole sole;
  sole.segment = RigidRoot(robot.model, segment);
  const std::vector<Eigen::Isometry3d> X_WS = PosesAtRest(robot.model);
  sole.down_S = -X_WS[sole.segment].linear().row(2).transpose();
  choice.depth ? TakeGiven(choice, &sole) : AddBodies(robot, X_WS, choice.take, &sole);
  const bool lacks_meshes =
      choice.take == SoleChoice::Take::kMeshes && sole.source != Sole::Source::kMeshes;
  if (lacks_meshes) sole.shapes.clear();
  if (sole.shapes.empty() && choice.take == SoleChoice::Take::kAny) TakeNamed(robot, &sole);
  if (sole.shapes.empty()) {
    if (reason != nullptr) *reason = WhyNone(robot, sole.segment);
    return std::nullopt;
  }
  sole.depth = DepthOf(sole);
  if (sole.source == Sole::Source::kShapes && choice.take == SoleChoice::Take::kAny) {
    CompareWithMeshes(robot, X_WS, &sole);
  }
  const bool is_point = sole.source == Sole::Source::kNamed || sole.source == Sole::Source::kGiven;
  if (is_point && sole.doubt.empty()) {
    sole.doubt = fmt::format(
        "the sole is known as a place only ({}): without the foot's length and width its heel and "
        "its toes may be in the floor; {} gives them",
        sole.said, OptionText("sole"));
  }
  return sole;
}

}  // namespace mmm_converter
