// SPDX-License-Identifier: MIT
#include "common/retarget/limb_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kParallel = 0.9;      // |cos| of axes that meet nowhere in particular
constexpr double kAlong = 0.7;         // |cos| of a joint's axis that turns a limb about itself
constexpr double kLeastBeyond = 0.02;  // [m] of the next centre from the fold's
constexpr double kAlikeFolds = 0.85;   // second of two joints that fold a chain, over the first
constexpr double kAlikeSides = 0.75;   // shorter of the ways from straight to the limits
constexpr double kToesShare = 0.2;     // of the shank, from the ankle to an axis of toes
constexpr double kLevel = 0.4;         // horizontal part of a direction that tells where it points

const std::string& NameOf(const ZeroPose& zero, int segment) {
  return zero.model->segments()[segment].name;
}

struct DistalCentre {
  Vector3d p_W = Vector3d::Zero();
  int joint = -1;  ///< of the chain; -1: it has none, this is the last link's centre of mass
};

/// On the joint's axis, where that of the next joint which is not parallel is nearest.
Vector3d CentreOn(const ZeroPose& zero, const std::vector<int>& chain, std::size_t joint) {
  Vector3d p = zero.origin(chain[joint]);
  const Vector3d a = zero.axis(chain[joint]);
  for (std::size_t i = joint + 1; i < chain.size(); ++i) {
    if (std::abs(zero.axis(chain[i]).dot(a)) >= kParallel) continue;
    return NearestPoint(p, a, zero.origin(chain[i]), zero.axis(chain[i]), 0);
  }
  return p;
}

DistalCentre FindDistalCentre(const ZeroPose& zero, const LimbReading& limb) {
  const Vector3d middle = zero.origin(limb.chain[limb.beyond - 1]);
  const Vector3d fold = zero.axis(limb.chain[limb.fold]);
  for (std::size_t i = limb.beyond; i < limb.chain.size(); ++i) {
    const Vector3d centre = CentreOn(zero, limb.chain, i);
    const Vector3d along = centre - middle - (centre - middle).dot(fold) * fold;
    if (along.norm() < kLeastBeyond) continue;
    if (std::abs(along.normalized().dot(zero.axis(limb.chain[i]))) >= kAlong) continue;
    return {centre, static_cast<int>(i)};
  }
  return {zero.mass_centre[limb.chain.back()]};
}

BodyPoint Fix(const ZeroPose& zero, int segment, const Vector3d& p_W) {
  return {segment, zero.X_WS[segment].inverse() * p_W};
}

/// From knee to ankle where the limb is straight.
Vector3d StraightLower(const ZeroPose& zero, const LimbReading& limb) {
  const auto folded = [&](const Vector3d& p) {
    return Folded(zero, limb.chain, limb.fold, limb.straight, p);
  };
  return folded(FindDistalCentre(zero, limb).p_W) -
         folded(zero.origin(limb.chain[limb.beyond - 1]));
}

/// Of joints that fold alike those whose names say so, if any does: a shoulder behind a clavicle
/// folds an arm as an elbow.
void KeepNamed(const ZeroPose& zero, const std::vector<int>& chain, const char* name,
               std::vector<int>* alike) {
  std::vector<int> named;
  std::copy_if(alike->begin(), alike->end(), std::back_inserter(named), [&](int joint) {
    return ToLower(NameOf(zero, chain[joint])).find(name) != std::string::npos;
  });
  if (!named.empty()) *alike = named;
}

/// Of the joints that fold the chain as much as the one that does most: where they turn about one
/// centre, that whose axis lies most across the way the body faces. -1: they do not tell.
int MostAcross(const ZeroPose& zero, const std::vector<int>& chain, const std::vector<int>& alike,
               const Vector3d& normal) {
  const Vector3d facing = normal.cross(Vector3d::UnitZ());
  const auto along = [&](int joint) { return std::abs(zero.axis(chain[joint]).dot(facing)); };
  const int chosen = *std::min_element(alike.begin(), alike.end(),
                                       [&](int a, int b) { return along(a) < along(b); });
  for (const int other : alike) {
    if (other == chosen) continue;
    const double apart = (zero.origin(chain[other]) - zero.origin(chain[chosen])).norm();
    if (apart > kLeastBeyond || along(other) < along(chosen) + kLevel) return -1;
  }
  return chosen;
}

/// Of an elbow whose limits allow both: +1 where its end goes up as it turns against its axis, or
/// that does not tell, to the middle of the body.
int SenseAside(const ZeroPose& zero, const LimbReading& limb) {
  const int fold = limb.chain[limb.fold];
  const Vector3d way = -zero.axis(fold).cross(StraightLower(zero, limb).normalized());
  const Vector3d inwards = zero.origin(0) - zero.origin(fold);
  if (std::abs(way.z()) > kLevel) return way.z() > 0 ? 1 : -1;
  return way.dot(inwards) > 0 ? 1 : -1;
}

}  // namespace

LimbReading ReadLimb(const ZeroPose& zero, const std::vector<int>& chain, int fold, bool is_leg,
                     const Vector3d& normal) {
  const FoldSweep sweep = SweepChain(zero, chain);
  LimbReading limb{chain, fold, 0, is_leg};
  if (fold < 0) {
    Eigen::Index most = 0;
    sweep.change.maxCoeff(&most);
    std::vector<int> alike;
    for (int i = 0; i < sweep.change.size(); ++i) {
      const bool is_known = std::any_of(alike.begin(), alike.end(), [&](int other) {
        return LastOfFold(zero, chain, other) >= i;
      });
      if (sweep.change[i] >= kAlikeFolds * sweep.change[most] && !is_known) alike.push_back(i);
    }
    if (!is_leg) KeepNamed(zero, chain, "elbow", &alike);
    limb.fold = MostAcross(zero, chain, alike, normal);
    if (limb.fold < 0) {
      throw Error(
          fmt::format("the robot {}: {} and {} fold the same limb alike; say in a map "
                      "which is the {}",
                      zero.model->name(), NameOf(zero, chain[alike[0]]),
                      NameOf(zero, chain[alike[1]]), is_leg ? "knee" : "elbow"));
    }
  }
  while (limb.fold > 0 && LastOfFold(zero, chain, limb.fold - 1) >= limb.fold) --limb.fold;
  limb.beyond = LastOfFold(zero, chain, limb.fold) + 1;
  const Segment& joint = zero.model->segments()[chain[limb.fold]];
  limb.straight = sweep.straight[limb.fold];
  const double below = limb.straight - std::max(joint.lower, -std::numbers::pi);
  const double above = std::min(joint.upper, std::numbers::pi) - limb.straight;
  const bool is_full_turn = below + above > 1.9 * std::numbers::pi;
  if (!is_full_turn && below < kAlikeSides * above) limb.sense = 1;
  if (!is_full_turn && above < kAlikeSides * below) limb.sense = -1;
  if (zero.Turn(chain[limb.fold], limb.straight + 1) < zero.Turn(chain[limb.fold], limb.straight))
    limb.sense = -limb.sense;
  return limb;
}

void CutToes(const ZeroPose& zero, LimbReading* leg) {
  const DistalCentre ankle = FindDistalCentre(zero, *leg);
  if (ankle.joint < 0) return;
  const double shank = (ankle.p_W - zero.origin(leg->chain[leg->fold])).norm();
  for (std::size_t i = ankle.joint + 1; i < leg->chain.size(); ++i) {
    const Vector3d a = zero.axis(leg->chain[i]), to = zero.origin(leg->chain[i]) - ankle.p_W;
    const Vector3d away = to - to.dot(a) * a;
    const bool is_ahead = away.head<2>().norm() > std::abs(away.z());
    if (away.norm() < kToesShare * shank || !is_ahead) continue;
    leg->chain.resize(i);
    return;
  }
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
  map.beyond = limb.beyond;
  map.end = limb.chain.back();
  const int fold = limb.chain[limb.fold], last = limb.chain[limb.beyond - 1];
  const int before = zero.model->segments()[fold].parent;
  Vector3d left = zero.axis(fold);
  // Knees turn forwards about the left, elbows backwards; both: the straight limb's end goes back
  // as it turns about the left.
  int sense = limb.is_leg ? limb.sense : -limb.sense;
  if (sense == 0) {
    const double back = left.cross(StraightLower(zero, limb).normalized()).dot(forward);
    if (std::abs(back) > kLevel) sense = back < 0 ? 1 : -1;
    // An arm that folds neither way forward may as well fold upwards or to the middle.
    if (sense == 0 && !limb.is_leg) sense = SenseAside(zero, limb);
  }
  if (sense == 0) {
    throw Error(fmt::format("the robot {}: the limits of {} do not tell which way it folds",
                            zero.model->name(), NameOf(zero, fold)));
  }
  left *= sense;
  const Vector3d proximal = CentreBefore(zero, limb.chain, limb.fold), middle = zero.origin(fold);
  const DistalCentre distal = FindDistalCentre(zero, limb);
  map.proximal = Fix(zero, before, proximal);
  map.middle = Fix(zero, before, middle);
  map.distal = Fix(zero, last, distal.p_W);
  map.upper = MakeLimbSegment(before, zero.X_WS[before], proximal, middle, left);
  map.lower = MakeLimbSegment(last, zero.X_WS[last], zero.origin(last), distal.p_W, left);
  map.between = left.cross(zero.origin(last) - middle).norm();
  map.has_wrist = limb.beyond < static_cast<int>(limb.chain.size());
  map.R_ED = zero.X_WS[map.end].linear().transpose() * zero.X_WS[last].linear() * map.lower.R_SL;
  if (std::min(map.upper.length, map.lower.length) < kLeastBeyond) {
    throw Error(fmt::format(
        "the robot {}: {} folds no limb: it is {:.0f} and {:.0f} mm long before "
        "and behind it; say in a map which joint does",
        zero.model->name(), NameOf(zero, fold), 1e3 * map.upper.length, 1e3 * map.lower.length));
  }
  return map;
}

}  // namespace mmm_converter
