// SPDX-License-Identifier: MIT
#include "common/io/skeleton/skeleton_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "common/math/statistics.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kSampledFrames = 60;
// Shares of the leg's length. Bones that are shorter than a body's stand for no part of a limb.
constexpr double kLeastBone = 0.25;   // of thigh, shank, upper arm and forearm over the limb's
constexpr double kHipsApart = 0.08;   // 0.14 to 0.35 in skeletons at hand; dummies stand together
constexpr double kLeastToe = 0.05;    // from the ankle
constexpr double kLeastFront = 0.02;  // what knees and toes tell of the front
constexpr double kLeastAlike = 0.6;   // of the longer bone; a foot is 0.35 of the shank
constexpr double kTwins = 0.1;        // by how much the bones of left and right differ
constexpr double kShortestArm = 0.4, kLongestArm = 0.9;  // 0.55 to 0.75 in skeletons at hand
constexpr std::size_t kMostLimbs = 100;
// Of an upper body alone, shares of an arm's length. A leg is 1.3 to 1.8, a trunk's half 0.6.
constexpr double kLegs = 1.54, kOtherLimb = 0.7, kLeastTrunk = 0.3;

/// Joints of a limb from the trunk outwards; -1: not there.
struct LimbJoints {
  int first = -1, middle = -1, last = -1;
  bool is_whole() const { return first >= 0 && middle >= 0 && last >= 0; }
};

class BodyFinder {
 public:
  BodyFinder(const SkeletonMotion& motion, const BoneNames& names) : motion_(motion) {
    for (const std::string& name : motion.names) {
      names_.push_back(name.empty() ? BoneName() : names.Find(name));
    }
    std::vector<Eigen::Matrix3d> R;
    for (const int k : SpreadFrames(motion.num_frames, kSampledFrames)) {
      Matrix3Xd p;
      motion.pose(k, &p, &R);
      if (p.allFinite()) frames_.push_back(std::move(p));
    }
    if (frames_.empty()) return;
    for (int j = 0; j < motion.num_joints(); ++j) {
      bone_lengths_.push_back(Parent(j) < 0 ? 0 : Distance(j, Parent(j)));
    }
  }

  FoundBody Find() {
    FoundBody body;
    if (frames_.empty()) return body;
    LimbJoints legs[] = {FindLeg('L'), FindLeg('R')}, arms[] = {FindArm('L'), FindArm('R')};
    const LimbJoints named_arms[] = {arms[0], arms[1]};
    body.is_by_lengths = !IsLimb(legs[0]) || !IsLimb(legs[1]);
    if (body.is_by_lengths && !FindByLengths(legs, arms)) return FindUpperBody(named_arms);
    const auto& [left_leg, right_leg] = legs;
    body.leg_length = (LengthOf(left_leg) + LengthOf(right_leg)) / 2;
    const int pelvis = CommonAncestor(left_leg.first, right_leg.first);
    if (pelvis < 0) return FoundBody();
    const bool has_arms = IsLimb(arms[0]) && IsLimb(arms[1]);
    AddTrunk(pelvis, has_arms ? CommonAncestor(arms[0].first, arms[1].first) : -1, &body);
    const auto add = [&](BodyJoint what, const char* side, int joint) {
      if (joint >= 0) body.joints.push_back({what, side, joint, {}});
    };
    body.has_exchanged_sides = Sides(left_leg, right_leg, body.leg_length) < -0.5;
    const char* const sides[] = {body.has_exchanged_sides ? "R" : "L",
                                 body.has_exchanged_sides ? "L" : "R"};
    for (const int s : {0, 1}) {
      const LimbJoints& leg = s == 0 ? left_leg : right_leg;
      add(BodyJoint::kHip, sides[s], leg.first);
      add(BodyJoint::kKnee, sides[s], leg.middle);
      add(BodyJoint::kAnkle, sides[s], leg.last);
      add(BodyJoint::kToe, sides[s], FindToe(leg.last, body.leg_length));
      if (has_arms) AddArm(arms[s], sides[s], &body);
    }
    return body;
  }

 private:
  void AddTrunk(int pelvis, int thorax, FoundBody* body) const {
    const auto add = [&](BodyJoint what, int joint) {
      if (joint >= 0) body->joints.push_back({what, "", joint, {}});
    };
    add(BodyJoint::kPelvis, pelvis);
    if (thorax != pelvis) add(BodyJoint::kThorax, thorax);
    const int neck = FindTopmost({BoneKind::kNeck}, ' ', -1);
    if (neck != thorax) add(BodyJoint::kNeck, neck);
    add(BodyJoint::kHead, FindTopmost({BoneKind::kHead}, ' ', -1));
  }

  static void AddArm(const LimbJoints& arm, const char* side, FoundBody* body) {
    body->joints.push_back({BodyJoint::kShoulder, side, arm.first, {}});
    body->joints.push_back({BodyJoint::kElbow, side, arm.middle, {}});
    body->joints.push_back({BodyJoint::kWrist, side, arm.last, {}});
  }

  /// Two arms by their names, of a skeleton that has no other limbs, whose names may be unknown.
  FoundBody FindUpperBody(const LimbJoints arms[2]) const {
    if (!IsLimb(arms[0]) || !IsLimb(arms[1])) return {};
    const int thorax = CommonAncestor(arms[0].first, arms[1].first);
    if (thorax < 0) return {};
    const double arm = (LengthOf(arms[0]) + LengthOf(arms[1])) / 2;
    for (const LimbJoints& limb : AllLimbs()) {
      const bool is_trunk = IsBelow(limb.last, thorax) || IsBelow(thorax, limb.last);
      if (!is_trunk && LengthOf(limb) > kOtherLimb * arm) return {};
    }
    FoundBody body;
    body.leg_length = kLegs * arm;
    const int root = PathTo(thorax).front();
    AddTrunk(Distance(root, thorax) > kLeastTrunk * arm ? root : -1, thorax, &body);
    AddArm(arms[0], "L", &body);
    AddArm(arms[1], "R", &body);
    return body;
  }

  int Parent(int joint) const { return motion_.parents[static_cast<std::size_t>(joint)]; }
  BoneKind Kind(int joint) const { return names_[static_cast<std::size_t>(joint)].kind; }
  char Side(int joint) const { return names_[static_cast<std::size_t>(joint)].side; }

  bool IsBelow(int joint, int above) const {
    for (; joint >= 0; joint = Parent(joint)) {
      if (joint == above) return true;
    }
    return false;
  }

  int CommonAncestor(int a, int b) const {
    for (a = Parent(a); a >= 0; a = Parent(a)) {
      if (IsBelow(Parent(b), a)) return a;
    }
    return -1;
  }

  double Distance(int a, int b) const {
    std::vector<double> distances;
    for (const Matrix3Xd& p : frames_) distances.push_back((p.col(a) - p.col(b)).norm());
    return Median(distances);
  }

  /// From its parent to a joint.
  double BoneLength(int joint) const { return bone_lengths_[static_cast<std::size_t>(joint)]; }

  double LengthOf(const LimbJoints& limb) const {
    return Distance(limb.first, limb.middle) + Distance(limb.middle, limb.last);
  }

  /// Whether its two bones are as those of a limb.
  bool IsLimb(const LimbJoints& limb) const {
    if (!limb.is_whole()) return false;
    const double upper = Distance(limb.first, limb.middle);
    const double lower = Distance(limb.middle, limb.last);
    return std::min(upper, lower) > kLeastBone * (upper + lower);
  }

  /// The first joint of one of these kinds, by the order of kinds, then of the file; below: -1 for
  /// all.
  int FindTopmost(const std::vector<BoneKind>& kinds, char side, int below) const {
    for (const BoneKind kind : kinds) {
      for (int j = 0; j < motion_.num_joints(); ++j) {
        const BoneName& name = names_[static_cast<std::size_t>(j)];
        if (name.kind != kind || name.side != side) continue;
        if (below >= 0 && (j == below || !IsBelow(j, below))) continue;
        return j;
      }
    }
    return -1;
  }

  /// From the root to the joint itself.
  std::vector<int> PathTo(int joint) const {
    std::vector<int> path;
    for (; joint >= 0; joint = Parent(joint)) path.push_back(joint);
    std::reverse(path.begin(), path.end());
    return path;
  }

  /// Of the side that the path's end has: "hip" may also be the root.
  std::optional<std::size_t> FindIn(const std::vector<int>& path, BoneKind kind, std::size_t from,
                                    std::size_t end) const {
    for (std::size_t i = from; i < end; ++i) {
      if (Kind(path[i]) == kind && Side(path[i]) == Side(path.back())) return i;
    }
    return std::nullopt;
  }

  /// The joint between two of a path at which the shorter part is longest.
  int MiddleOf(const std::vector<int>& path, std::size_t first, std::size_t last) const {
    int middle = -1;
    double most = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double shorter =
          std::min(Distance(path[first], path[i]), Distance(path[i], path[last]));
      if (shorter > most) most = shorter, middle = path[i];
    }
    return middle;
  }

  /// Of a limb whose bones have no names that are known: two long bones above its end.
  LimbJoints LimbAbove(const std::vector<int>& path) const {
    constexpr double kShort = 0.3;  // of the bone below, as of a twist or a dummy
    LimbJoints limb;
    limb.last = path.back();
    double lower = 0;
    for (std::size_t i = path.size() - 1; i-- > 0;) {
      const int below = limb.middle < 0 ? limb.last : limb.middle;
      const double length = Distance(path[i], below);
      if (limb.middle < 0 && length > 0) {
        limb.middle = path[i];
        lower = length;
      } else if (limb.middle >= 0 && length > kShort * lower) {
        limb.first = path[i];
        return limb;
      }
    }
    return limb;
  }

  /// Joints and bones' ends below one, along the longest way.
  std::vector<int> LongestPathBelow(int joint) const {
    std::vector<double> lengths(names_.size(), -1);
    lengths[static_cast<std::size_t>(joint)] = 0;
    int end = joint;
    for (int j = joint + 1; j < motion_.num_joints(); ++j) {
      if (Parent(j) < 0 || lengths[static_cast<std::size_t>(Parent(j))] < 0) continue;
      double& length = lengths[static_cast<std::size_t>(j)];
      length = lengths[static_cast<std::size_t>(Parent(j))] + BoneLength(j);
      if (length > lengths[static_cast<std::size_t>(end)]) end = j;
    }
    std::vector<int> path = PathTo(end);
    path.erase(path.begin(), std::find(path.begin(), path.end(), joint));
    return path;
  }

  /// The two bones of a path that are alike and of which the shorter one is longest.
  LimbJoints LongestBones(const std::vector<int>& path) const {
    LimbJoints limb;
    double most = 0;
    for (std::size_t i = 2; i < path.size(); ++i) {
      const double upper = BoneLength(path[i - 1]), lower = BoneLength(path[i]);
      const double shorter = std::min(upper, lower);
      if (shorter <= most || shorter < kLeastAlike * std::max(upper, lower)) continue;
      most = shorter;
      limb = {path[i - 2], path[i - 1], path[i]};
    }
    return limb;
  }

  /// Of a limb whose end has no name that is known, below its first joint that has one.
  LimbJoints LimbBelow(const std::vector<BoneKind>& kinds, char side) const {
    LimbJoints limb;
    int top = 0;
    while (top < motion_.num_joints() &&
           (Side(top) != side || std::find(kinds.begin(), kinds.end(), Kind(top)) == kinds.end())) {
      ++top;
    }
    if (top == motion_.num_joints()) return limb;
    return LongestBones(LongestPathBelow(top));
  }

  bool AreTwins(const LimbJoints& a, const LimbJoints& b) const {
    const auto are_alike = [](double one, double other) {
      return std::abs(one - other) < kTwins * std::max(one, other);
    };
    return are_alike(BoneLength(a.middle), BoneLength(b.middle)) &&
           are_alike(BoneLength(a.last), BoneLength(b.last)) && !IsBelow(a.first, b.first) &&
           !IsBelow(b.first, a.first);
  }

  /// The limbs on the ways to where bones end, the longest first.
  std::vector<LimbJoints> AllLimbs() const {
    std::vector<bool> is_end(names_.size(), true);
    for (const int parent : motion_.parents) {
      if (parent >= 0) is_end[static_cast<std::size_t>(parent)] = false;
    }
    std::vector<LimbJoints> limbs;
    for (int j = 0; j < motion_.num_joints() && limbs.size() < kMostLimbs; ++j) {
      if (!is_end[static_cast<std::size_t>(j)]) continue;
      const LimbJoints limb = LongestBones(PathTo(j));
      const bool is_new = std::none_of(limbs.begin(), limbs.end(), [&](const LimbJoints& one) {
        return one.middle == limb.middle;
      });
      if (limb.is_whole() && is_new) limbs.push_back(limb);
    }
    std::sort(limbs.begin(), limbs.end(),
              [&](const LimbJoints& a, const LimbJoints& b) { return LengthOf(a) > LengthOf(b); });
    return limbs;
  }

  bool FindByLengths(LimbJoints legs[2], LimbJoints arms[2]) const {
    const std::vector<LimbJoints> limbs = AllLimbs();
    std::vector<std::pair<LimbJoints, LimbJoints>> twins;
    for (std::size_t i = 0; i + 1 < limbs.size() && twins.size() < 2; ++i) {
      if (!AreTwins(limbs[i], limbs[i + 1])) continue;
      if (i + 2 < limbs.size() && AreTwins(limbs[i], limbs[i + 2])) return false;
      twins.emplace_back(limbs[i], limbs[i + 1]);
      ++i;
    }
    if (twins.size() < 2) return false;
    std::tie(legs[0], legs[1]) = twins[0];
    std::tie(arms[0], arms[1]) = twins[1];
    const double length = LengthOf(legs[0]);
    const double share = LengthOf(arms[0]) / length;
    if (share < kShortestArm || share > kLongestArm) return false;
    const double sides = Sides(legs[0], legs[1], length);
    if (std::abs(sides) < 0.5) return false;
    if (sides < 0) std::swap(legs[0], legs[1]);
    double along = 0;
    for (const Matrix3Xd& p : frames_) {
      along += (p.col(arms[0].first) - p.col(arms[1].first))
                   .dot(p.col(legs[0].first) - p.col(legs[1].first));
    }
    if (along < 0) std::swap(arms[0], arms[1]);
    return true;
  }

  /// Of a limb whose other joints are known: the joint that is named, or one above it on its side
  /// where the bone that begins there is too short, as of half an upper arm.
  int FirstOf(const std::vector<int>& path, std::size_t named, const LimbJoints& limb) const {
    if (limb.middle < 0) return path[named];
    const double lower = Distance(limb.middle, limb.last);
    std::size_t first = named;
    while (first > 0 && Side(path[first - 1]) == Side(path[named]) &&
           Distance(path[first], limb.middle) < kLeastAlike * lower) {
      --first;
    }
    const double upper = Distance(path[first], limb.middle);
    return upper * kLeastAlike < lower && upper >= kLeastAlike * lower ? path[first] : path[named];
  }

  LimbJoints FindLeg(char side) const {
    using enum BoneKind;
    LimbJoints leg;
    leg.last = FindTopmost({kAnkle, kFoot}, side, -1);
    if (leg.last < 0) return LimbBelow({kHip, kLeg, kKnee}, side);
    const std::vector<int> path = PathTo(leg.last);
    const std::size_t end = path.size() - 1;
    auto knee = FindIn(path, kKnee, 0, end);
    auto hip = FindHip(path, knee.value_or(end), side);
    const auto other = FindIn(path, kLeg, hip ? *hip + 1 : 0, knee.value_or(end));
    if (other && !hip) {
      hip = other;
    } else if (other && !knee) {
      knee = other;
    }
    if (!hip) return LimbAbove(path);
    leg.middle = knee ? path[*knee] : MiddleOf(path, *hip, end);
    leg.first = FirstOf(path, *hip, leg);
    return leg;
  }

  /// Skips dummies at the pelvis, where left and right stand together.
  std::optional<std::size_t> FindHip(const std::vector<int>& path, std::size_t end,
                                     char side) const {
    auto hip = FindIn(path, BoneKind::kHip, 0, end);
    while (hip) {
      const auto next = FindIn(path, BoneKind::kHip, *hip + 1, end);
      const int other = OtherSide(path[*hip], side);
      const bool is_dummy = other >= 0 && Distance(path[*hip], other) <
                                              kHipsApart * Distance(path[*hip], path.back());
      if (!next || !is_dummy) return hip;
      hip = next;
    }
    return hip;
  }

  /// The first joint of the kind on the other side.
  int OtherSide(int joint, char side) const {
    return FindTopmost({Kind(joint)}, side == 'L' ? 'R' : 'L', -1);
  }

  LimbJoints FindArm(char side) const {
    using enum BoneKind;
    LimbJoints arm;
    arm.last = FindTopmost({kWrist, kHand}, side, -1);
    if (arm.last < 0) return LimbBelow({kCollar, kShoulder, kUpperArm, kArm, kElbow}, side);
    const std::vector<int> path = PathTo(arm.last);
    const std::size_t end = path.size() - 1;
    auto elbow = FindIn(path, kElbow, 0, end);
    auto shoulder = FindIn(path, kUpperArm, 0, end);
    const auto plain = FindIn(path, kArm, shoulder ? *shoulder + 1 : 0, elbow.value_or(end));
    if (plain && !shoulder) {
      shoulder = plain;
    } else if (plain && !elbow) {
      elbow = plain;
    }
    if (!shoulder) {
      for (std::size_t i = 0; i < elbow.value_or(end); ++i) {
        if (Kind(path[i]) == kShoulder && Side(path[i]) == side) shoulder = i;
      }
    }
    if (!shoulder) return LimbAbove(path);
    arm.middle = elbow ? path[*elbow] : MiddleOf(path, *shoulder, end);
    arm.first = FirstOf(path, *shoulder, arm);
    return arm;
  }

  int FindToe(int ankle, double leg_length) const {
    const char side = Side(ankle);
    std::vector<BoneKind> kinds = {BoneKind::kToe};
    if (Kind(ankle) == BoneKind::kAnkle) kinds.push_back(BoneKind::kFoot);
    int toe = FindTopmost(kinds, side, ankle);
    const bool is_known = Kind(ankle) == BoneKind::kAnkle || Kind(ankle) == BoneKind::kFoot;
    for (int j = ankle + 1; j < motion_.num_joints() && toe < 0; ++j) {
      const bool has_name = !motion_.names[static_cast<std::size_t>(j)].empty();
      if (Parent(j) == ankle && (!has_name || !is_known)) toe = j;
    }
    return toe >= 0 && Distance(ankle, toe) > kLeastToe * leg_length ? toe : -1;
  }

  /// Knees bend to the front, and toes are there: 1 where these tell that left is left, -1 where it
  /// is right, 0 where they tell nothing.
  double Sides(const LimbJoints& left, const LimbJoints& right, double leg_length) const {
    double sum = 0, front_sum = 0;
    for (const Matrix3Xd& p : frames_) {
      Vector3d front = Vector3d::Zero(), up = Vector3d::Zero();
      for (const LimbJoints* leg : {&left, &right}) {
        const Vector3d along = p.col(leg->first) - p.col(leg->last);
        front += p.col(leg->middle) - (p.col(leg->first) + p.col(leg->last)) / 2;
        up += along;
        const int toe = FindToe(leg->last, leg_length);
        if (toe >= 0) front += (p.col(toe) - p.col(leg->last)) / 2;
      }
      if (up.norm() == 0) continue;
      up.normalize();
      const Vector3d across = p.col(left.first) - p.col(right.first);
      if (across.norm() == 0) continue;
      front -= up * up.dot(front);
      sum += across.normalized().dot(up.cross(front));
      front_sum += front.norm();
    }
    const auto count = static_cast<double>(frames_.size());
    return front_sum / count > kLeastFront * leg_length ? sum / front_sum : 0;
  }

  const SkeletonMotion& motion_;
  std::vector<BoneName> names_;
  std::vector<Matrix3Xd> frames_;
  std::vector<double> bone_lengths_;
};

}  // namespace

std::vector<int> SpreadFrames(int num_frames, int most) {
  const int count = std::min(num_frames, most);
  std::vector<int> frames;
  frames.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    frames.push_back(static_cast<int>(static_cast<long>(i) * num_frames / count));
  }
  return frames;
}

FoundBody FindBody(const SkeletonMotion& motion, const BoneNames& names) {
  return BodyFinder(motion, names).Find();
}

}  // namespace mmm_converter
