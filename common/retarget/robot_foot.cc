// SPDX-License-Identifier: MIT
#include "common/retarget/robot_foot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/math/rotation.h"
#include "common/math/square.h"
#include "common/support/advice.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kGivenThickness = 0.01;  // [m]
constexpr double kTilts[] = {0.3, 1};     // of directions in which the sole's ends are the lowest
constexpr int kAround = 8;                // of these
constexpr double kLeastSpread = 0.05, kMostSpread = 1;  // [rad] of a leg at the zero pose
constexpr double kSamePlace = 1e-4;                     // [m]
constexpr double kFlatTurn = 0.05;  // [rad] by which a foot that lies flat rises about its edges
constexpr double kFlatLever = 0.1;  // of its length or width, from the ankle to an edge
// A hull's corners that are kept above the floor: as the foot tilts so far, the others are above
// these by no more than half of what a foot may be in the floor.
constexpr double kHullTolerance = 0.0005;                        // [m]
constexpr std::array kHullTilts = {0.03, 0.15, 0.35, 0.7, 1.2};  // [rad]
constexpr int kHullAround = 32;                                  // directions of each
constexpr std::size_t kMostHullBalls = 64;
constexpr int kFineTilts = 25, kFineAround = 72;  // as far, in steps of 0.05 rad and 5 degrees
// A round edge that rolls moves all but one height of what is near the floor: at this one none of
// the 2 mm that count as bearing (foot_figures.cc) is faster than 10 mm/s up to 7 rad/s, the most
// that heels of walkers have.
constexpr double kPivot = 0.0006;  // [m]

void AddBall(int segment, const Vector3d& p_S, double radius, std::vector<FloorBall>* balls) {
  const bool is_known = std::any_of(balls->begin(), balls->end(), [&](const FloorBall& ball) {
    return (ball.p_S - p_S).norm() < kSamePlace && ball.radius == radius;
  });
  if (!is_known) balls->push_back({segment, p_S, radius});
}

/// The directions that are down as the foot tilts so far, in its segment.
template <typename Tilts>
std::vector<Vector3d> DownsOf(const RobotFoot& foot, const Tilts& tilts, int around) {
  std::vector<Vector3d> downs{-foot.R_FA.col(2)};
  for (const double tilt : tilts) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const double across = std::sin(tilt);
      downs.push_back(foot.R_FA * Vector3d(across * std::cos(angle), across * std::sin(angle),
                                           -std::cos(tilt)));
    }
  }
  return downs;
}

bool IsHull(const ContactShape& shape) { return shape.kind == ContactShape::Kind::kHull; }

/// Of all hulls, in each direction; nothing where there are none.
std::vector<Vector3d> LowestCorners(const RobotFoot& foot, const std::vector<Vector3d>& downs) {
  std::vector<Vector3d> lowest;
  for (const Vector3d& down : downs) {
    double most = -INFINITY;
    for (const ContactShape& shape : foot.shapes) {
      if (!IsHull(shape)) continue;
      const Vector3d p = SupportPoint(shape, down);
      if (std::isinf(most)) lowest.push_back(p);
      if (p.dot(down) > most) lowest.back() = p;
      most = std::max(most, p.dot(down));
    }
  }
  return lowest;
}

/// Of hulls as few corners as come so near to them in all directions, the worst first.
void AddHullBalls(RobotFoot* foot) {
  const std::vector<Vector3d> downs = DownsOf(*foot, kHullTilts, kHullAround);
  const std::vector<Vector3d> lowest = LowestCorners(*foot, downs);
  std::vector<double> reached(lowest.size(), -INFINITY);
  for (std::size_t count = 0; count < kMostHullBalls && !lowest.empty(); ++count) {
    std::size_t worst = 0;
    double most = -INFINITY;
    for (std::size_t i = 0; i < downs.size(); ++i) {
      const double missing = lowest[i].dot(downs[i]) - reached[i];
      if (missing > most) worst = i;
      most = std::max(most, missing);
    }
    if (most < kHullTolerance) return;
    for (std::size_t i = 0; i < downs.size(); ++i) {
      reached[i] = std::max(reached[i], lowest[worst].dot(downs[i]));
    }
    AddBall(foot->segment, lowest[worst], 0, &foot->balls);
  }
}

void AddBearing(RobotFoot* foot) {
  foot->bearing = foot->balls;
  std::array<double, kFineTilts> tilts = {};
  for (int i = 0; i < kFineTilts; ++i) tilts[static_cast<std::size_t>(i)] = 0.05 * (i + 0.5);
  for (const Vector3d& p : LowestCorners(*foot, DownsOf(*foot, tilts, kFineAround))) {
    AddBall(foot->segment, p, 0, &foot->bearing);
  }
  if (std::any_of(foot->shapes.begin(), foot->shapes.end(), &IsHull)) foot->pivot = kPivot;
}

/// Points of a shape that may be its lowest ones as the foot tilts.
void AddBalls(const RobotFoot& foot, const ContactShape& shape, std::vector<FloorBall>* balls) {
  const Eigen::Isometry3d& X = shape.X_SG;
  if (IsHull(shape)) return;  // AddHullBalls
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

/// Seen from the side, the ways along a foot's outline from its lowest point to each of these
/// places (x, z).
std::vector<double> WaysAlong(const std::vector<Eigen::Vector2d>& places) {
  std::vector<Eigen::Vector2d> sorted = places, outline;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  for (const Eigen::Vector2d& p : sorted) {
    while (outline.size() > 1) {
      const Eigen::Vector2d &a = outline[outline.size() - 2], &b = outline.back();
      if ((b - a).x() * (p - b).y() > (b - a).y() * (p - b).x()) break;
      outline.pop_back();
    }
    outline.push_back(p);
  }
  const auto lowest = std::min_element(outline.begin(), outline.end(),
                                       [](const auto& a, const auto& b) { return a.y() < b.y(); });
  std::vector<double> ways(outline.size());
  const auto base = static_cast<std::size_t>(lowest - outline.begin());
  ways[base] = outline[base].x();
  for (std::size_t i = base + 1; i < outline.size(); ++i) {
    ways[i] = ways[i - 1] + (outline[i] - outline[i - 1]).norm();
  }
  for (std::size_t i = base; i-- > 0;) ways[i] = ways[i + 1] - (outline[i + 1] - outline[i]).norm();
  std::vector<double> found;
  for (const Eigen::Vector2d& p : places) {
    std::size_t i = 0;
    while (i + 2 < outline.size() && outline[i + 1].x() < p.x()) ++i;
    const std::size_t next = std::min(i + 1, outline.size() - 1);
    const double step = outline[next].x() - outline[i].x();
    found.push_back(step > 0 ? ways[i] + (ways[next] - ways[i]) * (p.x() - outline[i].x()) / step
                             : ways[i]);
  }
  return found;
}

/// A round edge is as long as its arc, not as its shadow.
std::vector<Eigen::Vector2d> RolledPlaces(const RobotFoot& foot) {
  std::vector<Eigen::Vector2d> of_side, of_front;
  for (const FloorBall& ball : foot.bearing) {
    const Vector3d p =
        foot.R_FA.transpose() * (ball.p_S - ball.radius * foot.R_FA.col(2) - foot.sole);
    of_side.emplace_back(p.x(), p.z());
    of_front.emplace_back(p.y(), p.z());
  }
  const std::vector<double> x = WaysAlong(of_side), y = WaysAlong(of_front);
  std::vector<Eigen::Vector2d> places;
  for (std::size_t i = 0; i < x.size(); ++i) places.emplace_back(x[i], y[i]);
  return places;
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

constexpr int kQuarterings = 10;  // of a step: to a millionth

/// Where a height is least, downhill from 0 [rad]; 0 where it is not as of what lies flat: turned
/// by kFlatTurn either way it is higher by that times lever [m] at least.
template <typename Height>
double FlatAngle(double lever, const Height& height) {
  double at = 0;
  double step = kFlatTurn;
  for (int i = 0; i < kQuarterings; ++i, step /= 4) {
    const double way = height(at + step) < height(at - step) ? step : -step;
    while (height(at + way) < height(at) && std::abs(at) < kMostSpread) at += way;
  }
  const double rise = std::min(height(at - kFlatTurn), height(at + kFlatTurn)) - height(at);
  return rise > kFlatTurn * lever ? at : 0;
}

/// From where a foot is at the zero pose to where it lies flat: there its ankle is lowest. Feet
/// that are hardly tilted, or round, stay.
Eigen::Matrix3d LaidFlat(const RobotFoot& foot, const Vector3d& ankle_S) {
  double pitch = 0, roll = 0;
  const auto turned = [](double by_pitch, double by_roll) {
    return Eigen::Matrix3d(Eigen::AngleAxisd(by_pitch, Vector3d::UnitY()) *
                           Eigen::AngleAxisd(by_roll, Vector3d::UnitX()));
  };
  const auto height = [&](double by_pitch, double by_roll) {
    const Vector3d down_A = -turned(by_pitch, by_roll).col(2);
    return (FarthestOf(foot, down_A) - ankle_S).dot(foot.R_FA * down_A);
  };
  const auto lever = [&](int axis) {
    const Vector3d across = foot.R_FA.col(axis);
    return kFlatLever *
           (FarthestOf(foot, Vector3d::Unit(axis)) - FarthestOf(foot, -Vector3d::Unit(axis)))
               .dot(across);
  };
  for (int pass = 0; pass < 3; ++pass) {
    pitch = FlatAngle(lever(0), [&](double angle) { return height(angle, roll); });
    roll = FlatAngle(lever(1), [&](double angle) { return height(pitch, angle); });
  }
  return std::hypot(pitch, roll) < kLeastSpread ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                                : turned(pitch, roll);
}

/// Under the foot's centre of mass, if that is known and above it, else under its joint.
ContactShape GivenBox(const Robot& robot, const RobotFoot& foot, const SoleChoice& choice) {
  const Segment& segment = robot.model.segments()[foot.segment];
  const double length = choice.size->x();
  const double mass_centre = segment.mass > 0 ? foot.R_FA.col(0).dot(segment.p_SB) : 0;
  ContactShape box;
  box.kind = ContactShape::Kind::kBox;
  box.segment = foot.segment;
  box.half = 0.5 * Vector3d(length, choice.size->y(), kGivenThickness);
  box.X_SG.linear() = foot.R_FA;
  box.X_SG.translation() = foot.R_FA * Vector3d(std::clamp(mass_centre, -length / 2, length / 2), 0,
                                                0.5 * kGivenThickness - *choice.depth);
  return box;
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
  Vector3d bears = foot.sole, rolled = Vector3d::Zero();
  double lowest = INFINITY;
  for (std::size_t i = 0; i < foot.bearing.size(); ++i) {
    const FloorBall& ball = foot.bearing[i];
    const double height = X.linear().row(2).dot(ball.p_S) - ball.radius;
    if (height < lowest - kSamePlace) {
      bears = ball.p_S - ball.radius * foot.R_FA.col(2);
      rolled.head<2>() = foot.rolled[i];
    }
    lowest = std::min(lowest, height);
  }
  rolled += foot.pivot * Vector3d(-pitch, roll, 0);
  const Vector3d bears_W = Vector3d(place.x(), place.y(), 0) + R_WY * rolled;
  X.translation() = bears_W - X.linear() * bears;
  X.translation().z() -= LowestOf(foot, X);
  return X;
}

RobotFoot FindFoot(const Robot& robot, const std::vector<Eigen::Isometry3d>& X_WS,
                   const BodyMap& map, Side side, const SoleChoice& choice) {
  const LimbMap& leg = *map.leg(side);
  std::string reason;
  const auto sole = FindSole(robot, leg.end, choice, &reason);
  if (!sole) {
    throw Error(
        fmt::format("the robot {}: where the sole of its {} foot is, its file does not "
                    "say ({}); give the foot's length and width and the height of {} above the "
                    "sole ({})",
                    robot.model.name(), Name(side), reason, robot.model.segments()[leg.end].name,
                    OptionText("sole")));
  }
  RobotFoot foot;
  foot.segment = sole->segment;
  foot.said = sole->said;
  foot.doubt = sole->doubt;
  foot.rolls = static_cast<int>(leg.chain.size()) - leg.beyond > 1;
  foot.shapes = sole->shapes;
  foot.R_FA = (LevelKnee(X_WS, map, leg) * X_WS[foot.segment].linear()).transpose() * map.R_WA;
  const Vector3d ankle_W = X_WS[leg.distal.segment] * leg.distal.p_S;
  const Vector3d ankle_S = X_WS[foot.segment].inverse() * ankle_W;
  if (choice.size) foot.shapes = {GivenBox(robot, foot, choice)};
  foot.R_FA = foot.R_FA * LaidFlat(foot, ankle_S);
  for (const ContactShape& shape : foot.shapes) AddBalls(foot, shape, &foot.balls);
  AddHullBalls(&foot);
  AddBearing(&foot);
  const Eigen::Matrix3d R_AF = foot.R_FA.transpose();
  const Vector3d lowest = R_AF * FarthestOf(foot, -Vector3d::UnitZ());
  const double right = (R_AF * FarthestOf(foot, {0, -1, -3})).y();
  const double left = (R_AF * FarthestOf(foot, {0, 1, -3})).y();
  const Vector3d ankle = R_AF * ankle_S;
  foot.width = left - right;
  const double middle = 0.5 * (right + left);
  const auto place = [&](double x) {
    return Vector3d(foot.R_FA * Vector3d(x, middle, lowest.z()));
  };
  foot.sole = place(ankle.x());
  foot.heel = place((R_AF * FarthestOf(foot, {-1, 0, -3})).x());
  foot.toe = place((R_AF * FarthestOf(foot, {1, 0, -3})).x());
  foot.ankle_height = ankle.z() - lowest.z();
  foot.rolled = RolledPlaces(foot);
  return foot;
}

}  // namespace mmm_converter
