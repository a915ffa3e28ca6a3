// SPDX-License-Identifier: MIT
#include "common/retarget/robot_capsules.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "common/math/rotation.h"
#include "common/math/square.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr int kMostAbreast = 6;            // capsules that fill a plate
constexpr std::size_t kCloselyJoined = 2;  // joints between bodies that are joined closely
constexpr std::size_t kMostCapsules = 64;  // of a body
constexpr std::size_t kMostBodies = 300;   // the others are not watched
// Of what machines are made of, on average: lighter than wood or heavier than gold, the inertia is
// not that of a body [kg/m^3].
constexpr double kLeastDensity = 200, kMostDensity = 20000;
constexpr double kLeastMass = 0.02;  // [kg] of a body whose inertia tells a size

/// Fills a box with capsules along its longest side, abreast along the next one.
void AddBox(const Eigen::Isometry3d& X_SG, const Vector3d& half, CapsuleBody* body) {
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return half[a] > half[b]; });
  const double length = half[axes[0]], breadth = half[axes[1]], radius = half[axes[2]];
  const auto count = static_cast<int>(
      std::clamp<double>(std::ceil(breadth / std::max(radius, 1e-6)), 1, kMostAbreast));
  for (int i = 0; i < count; ++i) {
    const double place = count == 1 ? 0 : (2.0 * i / (count - 1) - 1) * (breadth - radius);
    const Vector3d middle = place * Vector3d::Unit(axes[1]);
    const Vector3d along = (length - radius) * Vector3d::Unit(axes[0]);
    body->capsules.push_back({X_SG * (middle - along), X_SG * (middle + along), radius});
  }
}

void AddShape(const ContactShape& shape, const Eigen::Isometry3d& X_SG, CapsuleBody* body) {
  using Kind = ContactShape::Kind;
  // Sides of a square as large as the circle, of a box as large as the ellipsoid.
  const double square = 0.5 * std::sqrt(std::numbers::pi), cube = std::cbrt(std::numbers::pi / 6);
  switch (shape.kind) {
    case Kind::kBox:
      return AddBox(X_SG, shape.half, body);
    case Kind::kEllipsoid:
      return AddBox(X_SG, cube * shape.half, body);
    case Kind::kCylinder:
      if (shape.half_length < shape.radius) {
        return AddBox(X_SG, {square * shape.radius, square * shape.radius, shape.half_length},
                      body);
      }
      break;
    default:
      break;
  }
  double along = 0;
  if (shape.kind == Kind::kCapsule) along = shape.half_length;
  if (shape.kind == Kind::kCylinder) along = shape.half_length - shape.radius;
  body->capsules.push_back(
      {X_SG * Vector3d(0, 0, -along), X_SG * Vector3d(0, 0, along), shape.radius});
}

/// Of what is fixed to one segment: mass, its centre and inertia about it, in the segment.
struct RigidMass {
  double mass = 0;
  Vector3d centre = Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();

  void Add(const Segment& segment, const Eigen::Isometry3d& X_RS) {
    if (segment.mass <= 0) return;
    const Vector3d place = X_RS * segment.p_SB;
    const double sum = mass + segment.mass;
    const Eigen::Matrix3d cross = Skew(place - centre);
    inertia += X_RS.linear() * segment.inertia * X_RS.linear().transpose() -
               mass * segment.mass / sum * cross * cross;
    centre += segment.mass / sum * (place - centre);
    mass = sum;
  }
};

/// The box of even density: I_x = m (h_y^2 + h_z^2) / 3.
bool AddMassBox(const RigidMass& rigid, CapsuleBody* body) {
  if (rigid.mass < kLeastMass) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(rigid.inertia);
  const Vector3d& I = principal.eigenvalues();
  const Vector3d squares =
      1.5 / rigid.mass * (Vector3d::Constant(I.sum()) - 2 * I);  // I_y + I_z - I_x
  if (!(squares.minCoeff() > 0)) return false;
  const Vector3d half = squares.cwiseSqrt();
  const double density = rigid.mass / (8 * half.prod());
  if (density < kLeastDensity || density > kMostDensity) return false;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = principal.eigenvectors();
  X.translation() = rigid.centre;
  body->is_by_mass = true;
  AddBox(X, half, body);
  return true;
}

/// Instead of more capsules than are looked at in time: the box around all of them.
void KeepFew(CapsuleBody* body) {
  if (body->capsules.size() <= kMostCapsules) return;
  Vector3d least = Vector3d::Constant(std::numeric_limits<double>::infinity()), most = -least;
  for (const BodyCapsule& one : body->capsules) {
    for (const Vector3d& end : {one.a_S, one.b_S}) {
      least = least.cwiseMin((end.array() - one.radius).matrix());
      most = most.cwiseMax((end.array() + one.radius).matrix());
    }
  }
  body->capsules.clear();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = (least + most) / 2;
  AddBox(X, (most - least) / 2, body);
}

void FindReach(CapsuleBody* body) {
  Vector3d sum = Vector3d::Zero();
  for (const BodyCapsule& one : body->capsules) sum += one.a_S + one.b_S;
  body->centre_S = sum / (2.0 * static_cast<double>(body->capsules.size()));
  for (const BodyCapsule& one : body->capsules) {
    for (const Vector3d& end : {one.a_S, one.b_S}) {
      body->reach = std::max(body->reach, (end - body->centre_S).norm() + one.radius);
    }
  }
}

std::string NameOfLink(const Robot& robot, int segment) {
  for (const Robot::Link& link : robot.links) {
    if (link.segment == segment && !link.name.empty()) return link.name;
  }
  return robot.model.segments()[segment].name;
}

/// Of each segment.
std::vector<BodyPart> PartsOf(const KinematicModel& model, const BodyMap& map) {
  std::vector<BodyPart> parts(model.segments().size(), BodyPart::kTrunk);
  const auto mark = [&](const std::optional<LimbMap>& limb, BodyPart part) {
    if (!limb) return;
    const int first = limb->chain.front();
    parts[first] = part;
    for (std::size_t s = 0; s < parts.size(); ++s) {
      const int parent = model.segments()[s].parent;
      if (parent >= first && parts[parent] == part) parts[s] = part;
    }
  };
  mark(map.legs[0], BodyPart::kLeftLeg);
  mark(map.legs[1], BodyPart::kRightLeg);
  mark(map.arms[0], BodyPart::kLeftArm);
  mark(map.arms[1], BodyPart::kRightArm);
  return parts;
}

/// Nearest places of two lines from a to b.
struct NearestPlaces {
  Vector3d first, second;
};
NearestPlaces FindNearest(const Vector3d& a1, const Vector3d& b1, const Vector3d& a2,
                          const Vector3d& b2) {
  const Vector3d d1 = b1 - a1, d2 = b2 - a2, r = a1 - a2;
  const double l1 = d1.squaredNorm(), l2 = d2.squaredNorm();
  const double along = d1.dot(d2), from1 = d1.dot(r), from2 = d2.dot(r);
  const double across = l1 * l2 - along * along;
  double s = across > 1e-12 * l1 * l2 ? (along * from2 - from1 * l2) / across : 0.5;
  s = std::clamp(s, 0.0, 1.0);
  double t = l2 > 0 ? std::clamp((along * s + from2) / l2, 0.0, 1.0) : 0;
  s = l1 > 0 ? std::clamp((along * t - from1) / l1, 0.0, 1.0) : 0;
  return {a1 + s * d1, a2 + t * d2};
}

}  // namespace

RobotCapsules FindCapsules(const Robot& robot, const BodyMap& map) {
  const KinematicModel& model = robot.model;
  const auto count = model.segments().size();
  const std::vector<BodyPart> parts = PartsOf(model, map);
  std::vector<Eigen::Isometry3d> X_RS(count, Eigen::Isometry3d::Identity());
  std::vector<int> roots(count);
  std::vector<RigidMass> masses(count);
  std::vector<CapsuleBody> found(count);
  for (std::size_t s = 0; s < count; ++s) {
    roots[s] = RigidRoot(model, static_cast<int>(s));
    const Segment& segment = model.segments()[s];
    if (roots[s] != static_cast<int>(s)) X_RS[s] = X_RS[segment.parent] * segment.X_PF;
    masses[roots[s]].Add(segment, X_RS[s]);
  }
  for (const ContactShape& shape : robot.shapes) {
    AddShape(shape, X_RS[shape.segment] * shape.X_SG, &found[roots[shape.segment]]);
  }
  RobotCapsules capsules;
  for (std::size_t s = 0; s < count; ++s) {
    CapsuleBody& body = found[s];
    if (roots[s] != static_cast<int>(s)) continue;
    body.name = NameOfLink(robot, static_cast<int>(s));
    body.segment = static_cast<int>(s);
    body.part = parts[s];
    if (body.capsules.empty() && !AddMassBox(masses[s], &body)) {
      if (masses[s].mass >= kLeastMass) capsules.unknown.push_back(body.name);
      continue;
    }
    KeepFew(&body);
    FindReach(&body);
    if (capsules.bodies.size() == kMostBodies) {
      capsules.unknown.push_back(body.name);
      continue;
    }
    capsules.bodies.push_back(std::move(body));
  }
  return capsules;
}

void PairBodies(const KinematicModel& model, const BodyMap& map, RobotCapsules* capsules) {
  // Of each body, itself first: as many as can join it closely to another one.
  std::vector<std::vector<int>> above;
  for (const CapsuleBody& body : capsules->bodies) {
    std::vector<int>& all = above.emplace_back(1, body.segment);
    while (all.size() <= kCloselyJoined) {
      const int parent = model.segments()[all.back()].parent;
      if (parent < 0) break;
      all.push_back(RigidRoot(model, parent));
    }
  }
  const auto are_joined_closely = [&](std::size_t a, std::size_t b) {
    for (std::size_t i = 0; i < above[a].size(); ++i) {
      for (std::size_t j = 0; j < above[b].size() && i + j <= kCloselyJoined; ++j) {
        if (above[a][i] == above[b][j]) return true;
      }
    }
    return false;
  };
  // A thigh folds against the pelvis as far as its joints' limits let it.
  const auto is_thigh = [&](int segment) {
    return std::any_of(map.legs.begin(), map.legs.end(), [&](const std::optional<LimbMap>& leg) {
      return leg && RigidRoot(model, leg->upper.segment) == segment;
    });
  };
  const int pelvis = RigidRoot(model, map.pelvis);
  capsules->pairs.clear();
  for (std::size_t i = 0; i < capsules->bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < capsules->bodies.size(); ++j) {
      const CapsuleBody &a = capsules->bodies[i], &b = capsules->bodies[j];
      if (a.part == b.part || are_joined_closely(i, j)) continue;
      if ((a.segment == pelvis && is_thigh(b.segment)) ||
          (b.segment == pelvis && is_thigh(a.segment))) {
        continue;
      }
      capsules->pairs.emplace_back(static_cast<int>(i), static_cast<int>(j));
    }
  }
}

void PlaceCapsules(const RobotCapsules& capsules, const std::vector<Eigen::Isometry3d>& X_WS,
                   PlacedCapsules* placed) {
  placed->lines.clear();
  placed->begins.assign(1, 0);
  placed->centres.clear();
  for (const CapsuleBody& body : capsules.bodies) {
    const Eigen::Isometry3d& X = X_WS[body.segment];
    placed->centres.push_back(X * body.centre_S);
    for (const BodyCapsule& one : body.capsules) {
      placed->lines.push_back({X * one.a_S, X * one.b_S, one.radius});
    }
    placed->begins.push_back(static_cast<int>(placed->lines.size()));
  }
}

Touch FindTouch(const RobotCapsules& capsules, const PlacedCapsules& placed,
                const std::pair<int, int>& pair, double near) {
  const auto [first, second] = pair;
  Touch touch;
  touch.depth = -std::numeric_limits<double>::infinity();
  const double reach = capsules.bodies[first].reach + capsules.bodies[second].reach + near;
  if ((placed.centres[first] - placed.centres[second]).squaredNorm() > Square(reach)) return touch;
  for (int i = placed.begins[first]; i < placed.begins[first + 1]; ++i) {
    const PlacedCapsules::Line& one = placed.lines[i];
    for (int j = placed.begins[second]; j < placed.begins[second + 1]; ++j) {
      const PlacedCapsules::Line& other = placed.lines[j];
      const NearestPlaces places = FindNearest(one.a, one.b, other.a, other.b);
      const double depth = one.radius + other.radius - (places.first - places.second).norm();
      if (depth <= touch.depth || depth < -near) continue;
      touch = {depth, places.first, places.second};
    }
  }
  return touch;
}

}  // namespace mmm_converter
