// SPDX-License-Identifier: MIT
#include "common/retarget/limb_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kParallel = 0.9;      // |cos| of axes that meet nowhere in particular
constexpr double kAlong = 0.7;         // |cos| of a joint's axis that turns a limb about itself
constexpr double kLeastBeyond = 0.02;  // [m] of the next centre from the fold's
constexpr double kAlikeFolds = 0.85;   // second of two joints that fold a chain, over the first
constexpr double kAlikeSides = 0.75;   // shorter of the ways from straight to the limits
constexpr double kLevel = 0.4;         // horizontal part of a direction that tells where it points

const std::string& NameOf(const ZeroPose& zero, int segment) {
  return zero.model->segments()[segment].name;
}

/// Middle of the shortest way between two lines p + t a.
Vector3d NearestPoint(const Vector3d& p, const Vector3d& a, const Vector3d& q, const Vector3d& b) {
  const double cosine = a.dot(b), sine2 = 1 - cosine * cosine;
  const Vector3d between = q - p;
  const double s = (between.dot(a) - cosine * between.dot(b)) / sine2;
  const double t = (cosine * between.dot(a) - between.dot(b)) / sine2;
  return 0.5 * (p + s * a + q + t * b);
}

Vector3d ProximalCentre(const ZeroPose& zero, const LimbReading& limb) {
  if (limb.fold == 0) return zero.origin(limb.chain[0]);
  const int last = limb.chain[limb.fold - 1];
  for (int i = limb.fold - 2; i >= 0; --i) {
    const int other = limb.chain[i];
    if (std::abs(zero.axis(other).dot(zero.axis(last))) >= kParallel) continue;
    return NearestPoint(zero.origin(other), zero.axis(other), zero.origin(last), zero.axis(last));
  }
  return zero.origin(last);
}

struct DistalCentre {
  Vector3d p_W = Vector3d::Zero();
  bool is_joint = false;
};

DistalCentre FindDistalCentre(const ZeroPose& zero, const LimbReading& limb) {
  const Vector3d middle = zero.origin(limb.chain[limb.fold]);
  for (std::size_t i = limb.fold + 1; i < limb.chain.size(); ++i) {
    const Vector3d along = zero.origin(limb.chain[i]) - middle;
    if (along.norm() < kLeastBeyond) continue;
    if (std::abs(along.normalized().dot(zero.axis(limb.chain[i]))) >= kAlong) continue;
    return {zero.origin(limb.chain[i]), true};
  }
  return {zero.mass_centre[limb.chain.back()], false};
}

BodyPoint Fix(const ZeroPose& zero, int segment, const Vector3d& p_W) {
  return {segment, zero.X_WS[segment].inverse() * p_W};
}

/// From knee to ankle where the limb is straight.
Vector3d StraightLower(const ZeroPose& zero, const LimbReading& limb) {
  const int fold = limb.chain[limb.fold];
  const Segment& segment = zero.model->segments()[fold];
  const double now = std::clamp(segment.rest, segment.lower, segment.upper);
  const Vector3d lower = FindDistalCentre(zero, limb).p_W - zero.origin(fold);
  return Eigen::AngleAxisd(limb.straight - now, zero.axis(fold)) * lower;
}

}  // namespace

LimbReading ReadLimb(const ZeroPose& zero, const std::vector<int>& chain, int fold, bool is_leg) {
  const FoldSweep sweep = SweepChain(zero, chain);
  LimbReading limb{chain, fold, is_leg};
  if (fold < 0) {
    Eigen::Index most = 0;
    sweep.change.maxCoeff(&most);
    for (Eigen::Index i = 0; i < sweep.change.size(); ++i) {
      if (i == most || sweep.change[i] < kAlikeFolds * sweep.change[most]) continue;
      throw Error(
          fmt::format("the robot {}: {} and {} fold the same limb alike; say in a map "
                      "which is the {}",
                      zero.model->name(), NameOf(zero, chain[most]), NameOf(zero, chain[i]),
                      is_leg ? "knee" : "elbow"));
    }
    limb.fold = static_cast<int>(most);
  }
  const Segment& joint = zero.model->segments()[chain[limb.fold]];
  limb.straight = sweep.straight[limb.fold];
  const double below = limb.straight - std::max(joint.lower, -std::numbers::pi);
  const double above = std::min(joint.upper, std::numbers::pi) - limb.straight;
  const bool is_full_turn = below + above > 1.9 * std::numbers::pi;
  if (!is_full_turn && below < kAlikeSides * above) limb.sense = 1;
  if (!is_full_turn && above < kAlikeSides * below) limb.sense = -1;
  return limb;
}

Vector3d FoldsTowards(const ZeroPose& zero, const LimbReading& limb) {
  if (limb.sense == 0) return Vector3d::Zero();
  const Vector3d axis = limb.sense * zero.axis(limb.chain[limb.fold]);
  Vector3d way = axis.cross(StraightLower(zero, limb)).normalized();
  way.z() = 0;
  return way;
}

LimbSegment MakeLimbSegment(int segment, const Eigen::Isometry3d& X_WS, const Vector3d& proximal,
                            const Vector3d& distal, const Vector3d& left) {
  const Vector3d along = proximal - distal;
  const Vector3d across = along - along.dot(left) * left;
  LimbSegment half;
  half.segment = segment;
  half.length = across.norm();
  Eigen::Matrix3d R_WL;
  R_WL.col(2) = across.normalized();
  R_WL.col(1) = left;
  R_WL.col(0) = left.cross(R_WL.col(2));
  half.R_SL = X_WS.linear().transpose() * R_WL;
  return half;
}

LimbMap MakeLimb(const ZeroPose& zero, const LimbReading& limb, const Vector3d& forward) {
  LimbMap map;
  map.chain = limb.chain;
  map.fold = limb.fold;
  map.end = limb.chain.back();
  const int fold = limb.chain[limb.fold];
  const int before = zero.model->segments()[fold].parent;
  Vector3d left = zero.axis(fold);
  // Knees turn forwards about the left, elbows backwards; both: the straight limb's end goes back
  // as it turns about the left.
  int sense = limb.is_leg ? limb.sense : -limb.sense;
  if (sense == 0) {
    const double back = left.cross(StraightLower(zero, limb).normalized()).dot(forward);
    if (std::abs(back) > kLevel) sense = back < 0 ? 1 : -1;
  }
  if (sense == 0) {
    throw Error(fmt::format("the robot {}: the limits of {} do not tell which way it folds",
                            zero.model->name(), NameOf(zero, fold)));
  }
  left *= sense;
  const Vector3d proximal = ProximalCentre(zero, limb), middle = zero.origin(fold);
  const DistalCentre distal = FindDistalCentre(zero, limb);
  map.proximal = Fix(zero, before, proximal);
  map.middle = Fix(zero, before, middle);
  map.distal = Fix(zero, fold, distal.p_W);
  map.upper = MakeLimbSegment(before, zero.X_WS[before], proximal, middle, left);
  map.lower = MakeLimbSegment(fold, zero.X_WS[fold], middle, distal.p_W, left);
  map.has_wrist = limb.fold + 1 < static_cast<int>(limb.chain.size());
  map.R_ED = zero.X_WS[map.end].linear().transpose() * zero.X_WS[fold].linear() * map.lower.R_SL;
  if (std::min(map.upper.length, map.lower.length) < kLeastBeyond) {
    throw Error(fmt::format(
        "the robot {}: {} folds no limb: it is {:.0f} and {:.0f} mm long before "
        "and behind it; say in a map which joint does",
        zero.model->name(), NameOf(zero, fold), 1e3 * map.upper.length, 1e3 * map.lower.length));
  }
  return map;
}

}  // namespace mmm_converter
