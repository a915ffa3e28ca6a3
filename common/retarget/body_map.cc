// SPDX-License-Identifier: MIT
#include "common/retarget/body_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/retarget/limb_chains.h"
#include "common/retarget/limb_geometry.h"
#include "common/support/error.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kMostJoints = 200;  // of robots with hands some 100

using Eigen::Vector3d;
using Chains = std::array<std::vector<int>, 2>;

constexpr double kLeastFolding = 0.15;  // of a chain's reach: what bends less is no limb
constexpr double kAlikeArms = 0.9;      // second pair that folds, over the first
constexpr double kAlikeHeights =
    0.05;                           // of the robot's size, between the ends of two pairs of legs
constexpr double kHangs = 0.7;      // cosine of a leg to the vertical
constexpr double kLevelPart = 0.4;  // of a direction that votes
constexpr std::size_t kFewestNamed = 3;  // joints of one side that are called a limb's

/// A reason for where forward is, +1 or -1 along a direction.
struct Vote {
  int sign = 0;
  std::string reason;
};

std::string Describe(const ZeroPose& zero, const std::vector<int>& chain) {
  return fmt::format("{} to {}", zero.model->segments()[chain.front()].name,
                     zero.model->segments()[chain.back()].name);
}

/// +1: named as legs are, -1: as arms, 0: neither or both.
int RoleByNames(const ZeroPose& zero, const std::vector<int>& chain) {
  int role = 0;
  const auto has = [](const std::string& name, std::initializer_list<const char*> parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const char* part) { return name.find(part) != std::string::npos; });
  };
  for (const int segment : chain) {
    const std::string name = ToLower(zero.model->segments()[segment].name);
    if (has(name,
            {"hip", "knee", "ankle", "leg", "foot", "thigh", "shank", "femur", "tibia", "toe"}))
      role += 1;
    if (has(name, {"shoulder", "elbow", "wrist", "arm", "hand", "humerus", "radius"})) role -= 1;
  }
  return (role > 0 ? 1 : 0) - (role < 0 ? 1 : 0);
}

[[noreturn]] void Refuse(const ZeroPose& zero, const std::string& why) {
  throw Error(fmt::format("the robot {}: {}", zero.model->name(), why));
}

/// The pairs that bend as limbs do; of those that begin alike only the longest.
std::vector<MirroredPair> FindLimbPairs(const ZeroPose& zero) {
  std::vector<MirroredPair> pairs = FindMirroredPairs(zero);
  std::erase_if(pairs, [](const MirroredPair& pair) {
    return pair.most_folding < kLeastFolding * pair.reach;
  });
  std::stable_sort(pairs.begin(), pairs.end(), [](const MirroredPair& a, const MirroredPair& b) {
    return a.most_folding > b.most_folding;
  });
  std::vector<MirroredPair> kept;
  for (MirroredPair& pair : pairs) {
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const MirroredPair& other) {
      return other.chains[0][0] == pair.chains[0][0] || other.chains[0][0] == pair.chains[1][0];
    });
    if (!is_known) kept.push_back(std::move(pair));
  }
  return kept;
}

struct LimbPairs {
  const MirroredPair* legs = nullptr;
  const MirroredPair* arms = nullptr;
};

/// Of pairs that fold most first.
LimbPairs ChoosePairs(const ZeroPose& zero, const std::vector<MirroredPair>& pairs) {
  LimbPairs chosen;
  if (pairs.empty()) Refuse(zero, "no two chains of joints are images of each other");
  const bool stands = !zero.model->is_root_fixed();
  const auto lowest = std::min_element(
      pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.lowest < b.lowest; });
  if (!stands && RoleByNames(zero, lowest->chains[0]) > 0) {
    Refuse(zero, fmt::format("{} are named as legs are, and its file fixes it to the world; give "
                             "its root a free joint (<freejoint/>), or a map of its arms alone",
                             Describe(zero, lowest->chains[0])));
  }
  const bool is_arm = pairs.size() == 1 && RoleByNames(zero, lowest->chains[0]) < 0;
  if (stands && !is_arm) chosen.legs = &*lowest;
  for (const MirroredPair& pair : pairs) {
    if (&pair == chosen.legs) continue;
    if (chosen.legs != nullptr && pair.lowest < chosen.legs->lowest + kAlikeHeights * zero.size) {
      Refuse(zero,
             fmt::format("{} and {} end equally low; say in a map which are the legs",
                         Describe(zero, pair.chains[0]), Describe(zero, chosen.legs->chains[0])));
    }
    if (chosen.arms == nullptr) {
      chosen.arms = &pair;
    } else if (pair.most_folding > kAlikeArms * chosen.arms->most_folding) {
      Refuse(zero,
             fmt::format("{} and {} fold alike; say in a map which are the arms",
                         Describe(zero, pair.chains[0]), Describe(zero, chosen.arms->chains[0])));
    }
  }
  const auto check = [&](const MirroredPair* pair, int role, const char* what, const char* named) {
    if (pair == nullptr || RoleByNames(zero, pair->chains[0]) != -role) return;
    Refuse(zero, fmt::format("{} would be its {} by structure, and is named as {} are; say in a "
                             "map what is right",
                             Describe(zero, pair->chains[0]), what, named));
  };
  check(chosen.legs, 1, "legs", "arms");
  check(chosen.arms, -1, "arms", "legs");
  return chosen;
}

Vote NamesVote(const ZeroPose& zero, const Chains& chains, double to_first) {
  Vote vote;
  for (std::size_t i = 0; i < chains[0].size(); ++i) {
    const std::string& a = zero.model->segments()[chains[0][i]].name;
    const std::string& b = zero.model->segments()[chains[1][i]].name;
    const int side = SideByNames(a, b);
    if (side == 0) continue;
    const int sign = side * to_first > 0 ? 1 : -1;
    if (vote.sign != 0 && vote.sign != sign) {
      Refuse(zero, fmt::format("the names {} and {} exchange the sides of others of the same limbs",
                               a, b));
    }
    vote = {sign, fmt::format("names ({}, {})", side > 0 ? a : b, side > 0 ? b : a)};
  }
  return vote;
}

Vote FoldVote(const ZeroPose& zero, const LimbReading& limb, const Vector3d& along) {
  const double way = FoldsTowards(zero, limb).dot(along) * (limb.is_leg ? -1 : 1);
  if (std::abs(way) < kLevelPart) return {};
  const std::string& joint = zero.model->segments()[limb.chain[limb.fold]].name;
  return {way > 0 ? 1 : -1, fmt::format("{} {} folds {}", limb.is_leg ? "the knee" : "the elbow",
                                        joint, limb.is_leg ? "back" : "to the front")};
}

struct Limbs {
  std::vector<std::array<LimbReading, 2>> pairs;
  std::vector<Vector3d> normals;           ///< from the second to the first, level
  std::vector<std::string> left_out = {};  ///< BodyMap::left_out
};

Limbs ReadLimbs(const ZeroPose& zero, const LimbPairs& pairs) {
  Limbs limbs;
  for (const MirroredPair* pair : {pairs.legs, pairs.arms}) {
    if (pair == nullptr) continue;
    const bool is_leg = pair == pairs.legs;
    const Vector3d normal = Vector3d(pair->normal.x(), pair->normal.y(), 0).normalized();
    limbs.pairs.push_back({ReadLimb(zero, pair->chains[0], -1, is_leg, normal),
                           ReadLimb(zero, pair->chains[1], -1, is_leg, normal)});
    limbs.normals.push_back(normal);
    if (!is_leg) continue;
    for (LimbReading& leg : limbs.pairs.back()) CutToes(zero, &leg);
  }
  return limbs;
}

Vector3d FindForward(const ZeroPose& zero, const Limbs& limbs, std::vector<std::string>* evidence) {
  const Vector3d along = limbs.normals[0].cross(Vector3d::UnitZ());
  std::vector<Vote> votes;
  for (std::size_t i = 0; i < limbs.pairs.size(); ++i) {
    const auto& [first, second] = limbs.pairs[i];
    const double side = limbs.normals[i].dot(limbs.normals[0]);
    if (std::abs(side) < 0.9) {
      Refuse(zero,
             fmt::format("{} and {} are not images in the same plane", Describe(zero, first.chain),
                         Describe(zero, limbs.pairs[0][0].chain)));
    }
    votes.push_back(NamesVote(zero, {first.chain, second.chain}, side));
    for (const LimbReading* limb : {&first, &second}) votes.push_back(FoldVote(zero, *limb, along));
  }
  std::erase_if(votes, [](const Vote& vote) { return vote.sign == 0; });
  if (votes.empty()) {
    const LimbReading& limb = limbs.pairs[0][0];
    Refuse(zero, fmt::format("neither the limits of {} nor names tell where its front is; say so "
                             "in a map",
                             zero.model->segments()[limb.chain[limb.fold]].name));
  }
  for (const Vote& vote : votes) {
    if (vote.sign != votes[0].sign) {
      Refuse(zero,
             fmt::format("where its front is, {} and {} contradict each other; say so in a map",
                         votes[0].reason, vote.reason));
    }
    evidence->push_back(vote.reason);
  }
  return votes[0].sign * along;
}

/// The segment that carries the limbs, of what is rigid the first.
int CarrierOf(const ZeroPose& zero, const std::vector<int>& chain) {
  const int moving = zero.moving_parent[chain.front()];
  return moving >= 0 ? moving : 0;
}

int FindJointNamed(const ZeroPose& zero, const std::string& name) {
  const int segment = zero.model->FindSegment(std::string(Trim(name)));
  if (segment >= 0 && zero.Moves(segment)) return segment;
  if (segment >= 0) {
    Refuse(zero, fmt::format("the map names the joint \"{}\", which does not move: it is fixed, "
                             "slides in a URDF, or has equal limits",
                             name));
  }
  std::vector<std::string> joints;
  joints.reserve(static_cast<std::size_t>(zero.model->num_joints()));
  for (int j = 0; j < zero.model->num_joints(); ++j) joints.push_back(zero.model->joint(j).name);
  const std::string near = ClosestName(name, joints);
  Refuse(zero, fmt::format("the map names the joint \"{}\", which it has not{}; it has {}", name,
                           near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                           FirstNames(joints)));
}

LimbReading ChosenLimb(const ZeroPose& zero, const LimbChoice& choice, bool is_leg,
                       const Vector3d& normal) {
  const int first = FindJointNamed(zero, choice.first), last = FindJointNamed(zero, choice.last);
  std::vector<int> chain;
  for (int at = last; at >= 0; at = zero.moving_parent[at]) {
    chain.insert(chain.begin(), at);
    if (at == first) break;
  }
  if (chain.front() != first) {
    Refuse(zero,
           fmt::format("the map's limb from {} to {} is no chain", choice.first, choice.last));
  }
  int fold = -1;
  if (!choice.fold.empty()) {
    const auto at = std::find(chain.begin(), chain.end(), FindJointNamed(zero, choice.fold));
    if (at == chain.end()) {
      Refuse(zero, fmt::format("the map's {} is not between {} and {}", choice.fold, choice.first,
                               choice.last));
    }
    fold = static_cast<int>(at - chain.begin());
  }
  return ReadLimb(zero, chain, fold, is_leg, normal);
}

/// The chosen pairs, left first.
Limbs ChosenLimbs(const ZeroPose& zero, const BodyMapChoice& choice, bool are_legs) {
  Limbs limbs;
  const auto& two = are_legs ? choice.legs : choice.arms;
  if (!two[0] || !two[1]) return limbs;
  Vector3d n = zero.origin(FindJointNamed(zero, two[0]->last)) -
               zero.origin(FindJointNamed(zero, two[1]->last));
  n.z() = 0;
  n.normalize();
  limbs.pairs.push_back(
      {ChosenLimb(zero, *two[0], are_legs, n), ChosenLimb(zero, *two[1], are_legs, n)});
  limbs.normals.push_back(n);
  return limbs;
}

/// Joints outside the limbs that are named as a leg's or an arm's, left and right; left_out gets
/// them all.
std::vector<std::string> NamedOutside(const ZeroPose& zero, int role, Limbs* of) {
  const Limbs& limbs = *of;
  std::set<int> taken;
  for (const auto& pair : limbs.pairs) {
    for (const LimbReading& limb : pair) taken.insert(limb.chain.begin(), limb.chain.end());
  }
  std::vector<int> named;
  for (int s = 0; s < static_cast<int>(zero.X_WS.size()); ++s) {
    if (zero.Moves(s) && taken.count(s) == 0 && RoleByNames(zero, {s}) == role) named.push_back(s);
  }
  const auto name = [&](int segment) { return zero.model->segments()[segment].name; };
  if (named.size() >= kFewestNamed) {
    for (const int one : named) of->left_out.push_back(name(one));
  }
  std::vector<std::string> lefts;
  for (const int a : named) {
    const bool has_other = std::any_of(named.begin(), named.end(),
                                       [&](int b) { return SideByNames(name(a), name(b)) > 0; });
    if (has_other) lefts.push_back(name(a));
  }
  return lefts;
}

/// What looks like no limb and is called one is not left standing still in silence.
void CheckNoneIsLeft(const ZeroPose& zero, const LimbPairs& pairs, Limbs* limbs) {
  for (const bool is_leg : {true, false}) {
    if ((is_leg ? pairs.legs : pairs.arms) != nullptr) continue;
    const std::vector<std::string> names = NamedOutside(zero, is_leg ? 1 : -1, limbs);
    if (names.size() < kFewestNamed) continue;
    Refuse(zero, fmt::format("{} are named as {} are, but no two chains of them are images of each "
                             "other that fold; say in a map what the limbs are (those that it "
                             "leaves out are not used)",
                             FirstNames(names), is_leg ? "legs" : "arms"));
  }
}

/// What is chosen, and of the rest what the structure tells.
Limbs FindLimbs(const ZeroPose& zero, const BodyMapChoice& choice) {
  Limbs legs = ChosenLimbs(zero, choice, true);
  const Limbs arms = ChosenLimbs(zero, choice, false);
  if (legs.pairs.empty() && arms.pairs.empty()) {
    const std::vector<MirroredPair> pairs = FindLimbPairs(zero);
    const LimbPairs chosen = ChoosePairs(zero, pairs);
    Limbs limbs = ReadLimbs(zero, chosen);
    CheckNoneIsLeft(zero, chosen, &limbs);
    return limbs;
  }
  legs.pairs.insert(legs.pairs.end(), arms.pairs.begin(), arms.pairs.end());
  std::set<int> taken;
  for (const std::array<LimbReading, 2>& pair : legs.pairs) {
    for (const LimbReading& limb : pair) {
      for (const int segment : limb.chain) {
        if (taken.insert(segment).second) continue;
        Refuse(zero,
               fmt::format("the map has {} in two limbs", zero.model->segments()[segment].name));
      }
    }
  }
  legs.normals.insert(legs.normals.end(), arms.normals.begin(), arms.normals.end());
  return legs;
}

/// Two pairs of limbs, of which the lowest hangs down and is called no arm.
bool StandsOnLegs(const ZeroPose& zero) {
  const std::vector<MirroredPair> pairs = FindLimbPairs(zero);
  if (pairs.size() < 2) return false;
  const std::vector<int>& chain =
      std::min_element(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
        return a.lowest < b.lowest;
      })->chains[0];
  const Vector3d way = zero.mass_centre[chain.back()] - zero.origin(chain.front());
  return RoleByNames(zero, chain) >= 0 && way.normalized().z() < -kHangs;
}

}  // namespace

Eigen::Quaterniond FindStanding(const KinematicModel& model) {
  if (model.is_root_fixed() || model.num_joints() > kMostJoints) return model.standing();
  if (StandsOnLegs(ZeroPose(model))) return model.standing();
  std::vector<Eigen::Quaterniond> found;
  for (const Vector3d& up_S : {Vector3d(0, 1, 0), Vector3d(0, -1, 0), Vector3d(1, 0, 0),
                               Vector3d(-1, 0, 0), Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
    ModelDescription turned = DescriptionOf(model);
    turned.standing = Eigen::Quaterniond::FromTwoVectors(up_S, Vector3d::UnitZ());
    const KinematicModel candidate(std::move(turned));
    if (StandsOnLegs(ZeroPose(candidate))) found.push_back(candidate.standing());
  }
  return found.size() == 1 ? found.front() : model.standing();
}

std::string LimbName(bool is_leg, Side side) {
  return std::string(Name(side)) + (is_leg ? " leg" : " arm");
}

BodyMap FindBodyMap(const KinematicModel& model, const BodyMapChoice& choice) {
  if (model.num_joints() > kMostJoints) {
    throw Error(fmt::format("the robot {} has {} joints; a motion is brought to at most {}",
                            model.name(), model.num_joints(), kMostJoints));
  }
  const ZeroPose zero(model);
  BodyMap map;
  const Limbs limbs = FindLimbs(zero, choice);
  map.left_out = limbs.left_out;
  Vector3d forward;
  if (choice.forward) {
    forward = *choice.forward;
    map.evidence.emplace_back("the map says so");
  } else if (choice.legs[0] || choice.arms[0]) {
    forward = limbs.normals[0].cross(Vector3d::UnitZ());
    map.evidence.emplace_back("the map's left and right");
  } else {
    forward = FindForward(zero, limbs, &map.evidence);
  }
  map.R_WA.col(0) = Vector3d(forward.x(), forward.y(), 0).normalized();
  map.R_WA.col(2) = Vector3d::UnitZ();
  map.R_WA.col(1) = map.R_WA.col(2).cross(map.R_WA.col(0));
  for (std::size_t i = 0; i < limbs.pairs.size(); ++i) {
    const bool first_is_left = limbs.normals[i].dot(map.R_WA.col(1)) > 0;
    for (std::size_t j = 0; j < 2; ++j) {
      const LimbReading& limb = limbs.pairs[i][j];
      auto& two = limb.is_leg ? map.legs : map.arms;
      two[(j == 0) == first_is_left ? 0 : 1] = MakeLimb(zero, limb, map.R_WA.col(0));
    }
  }
  if (map.has_legs()) map.pelvis = CarrierOf(zero, map.legs[0]->chain);
  map.chest = map.has_arms() ? CarrierOf(zero, map.arms[0]->chain) : map.pelvis;
  map.R_PA = zero.X_WS[map.pelvis].linear().transpose() * map.R_WA;
  map.R_CA = zero.X_WS[map.chest].linear().transpose() * map.R_WA;
  return map;
}

}  // namespace mmm_converter
