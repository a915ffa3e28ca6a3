// SPDX-License-Identifier: MIT
#include "common/io/skeleton/skeleton_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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
  }

  FoundBody Find() {
    FoundBody body;
    if (frames_.empty()) return body;
    const LimbJoints left_leg = FindLeg('L'), right_leg = FindLeg('R');
    if (!left_leg.is_whole() || !right_leg.is_whole()) return body;
    LimbJoints arms[] = {FindArm('L'), FindArm('R')};
    const double left = LengthOf(left_leg), right = LengthOf(right_leg);
    body.leg_length = (left + right) / 2;
    if (!IsLimb(left_leg) || !IsLimb(right_leg)) return FoundBody();
    const int pelvis = CommonAncestor(left_leg.first, right_leg.first);
    if (pelvis < 0) return FoundBody();
    const auto add = [&](BodyJoint what, const char* side, int joint) {
      if (joint >= 0) body.joints.push_back({what, side, joint, {}});
    };
    add(BodyJoint::kPelvis, "", pelvis);
    const bool has_arms = IsLimb(arms[0]) && IsLimb(arms[1]);
    const int thorax = has_arms ? CommonAncestor(arms[0].first, arms[1].first) : -1;
    if (thorax != pelvis) add(BodyJoint::kThorax, "", thorax);
    const int head = FindTopmost({BoneKind::kHead}, ' ', -1);
    const int neck = FindTopmost({BoneKind::kNeck}, ' ', -1);
    if (neck != thorax) add(BodyJoint::kNeck, "", neck);
    add(BodyJoint::kHead, "", head);
    body.has_exchanged_sides = HasExchangedSides(left_leg, right_leg, body.leg_length);
    const char* const sides[] = {body.has_exchanged_sides ? "R" : "L",
                                 body.has_exchanged_sides ? "L" : "R"};
    for (const int s : {0, 1}) {
      const LimbJoints& leg = s == 0 ? left_leg : right_leg;
      add(BodyJoint::kHip, sides[s], leg.first);
      add(BodyJoint::kKnee, sides[s], leg.middle);
      add(BodyJoint::kAnkle, sides[s], leg.last);
      add(BodyJoint::kToe, sides[s], FindToe(leg.last, body.leg_length));
      if (!has_arms) continue;
      add(BodyJoint::kShoulder, sides[s], arms[s].first);
      add(BodyJoint::kElbow, sides[s], arms[s].middle);
      add(BodyJoint::kWrist, sides[s], arms[s].last);
    }
    return body;
  }

 private:
  int Parent(int joint) const { return motion_.parents[static_cast<std::size_t>(joint)]; }
  BoneKind Kind(int joint) const { return names_[static_cast<std::size_t>(joint)].kind; }

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

  std::optional<std::size_t> FindIn(const std::vector<int>& path, BoneKind kind, std::size_t from,
                                    std::size_t end) const {
    for (std::size_t i = from; i < end; ++i) {
      if (Kind(path[i]) == kind) return i;
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

  LimbJoints FindLeg(char side) const {
    LimbJoints leg;
    leg.last = FindTopmost({BoneKind::kAnkle, BoneKind::kFoot}, side, -1);
    if (leg.last < 0) return leg;
    const std::vector<int> path = PathTo(leg.last);
    const std::size_t end = path.size() - 1;
    auto knee = FindIn(path, BoneKind::kKnee, 0, end);
    auto hip = FindHip(path, knee.value_or(end), side);
    const auto other = FindIn(path, BoneKind::kLeg, hip ? *hip + 1 : 0, knee.value_or(end));
    if (other && !hip) {
      hip = other;
    } else if (other && !knee) {
      knee = other;
    }
    if (!hip) return LimbAbove(path);
    leg.first = path[*hip];
    leg.middle = knee ? path[*knee] : MiddleOf(path, *hip, end);
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
    LimbJoints arm;
    arm.last = FindTopmost({BoneKind::kWrist, BoneKind::kHand}, side, -1);
    if (arm.last < 0) return arm;
    const std::vector<int> path = PathTo(arm.last);
    const std::size_t end = path.size() - 1;
    auto elbow = FindIn(path, BoneKind::kElbow, 0, end);
    auto shoulder = FindIn(path, BoneKind::kUpperArm, 0, end);
    const auto plain =
        FindIn(path, BoneKind::kArm, shoulder ? *shoulder + 1 : 0, elbow.value_or(end));
    if (plain && !shoulder) {
      shoulder = plain;
    } else if (plain && !elbow) {
      elbow = plain;
    }
    if (!shoulder) {
      for (std::size_t i = 0; i < elbow.value_or(end); ++i) {
        if (Kind(path[i]) == BoneKind::kShoulder) shoulder = i;
      }
    }
    if (!shoulder) return LimbAbove(path);
    arm.first = path[*shoulder];
    arm.middle = elbow ? path[*elbow] : MiddleOf(path, *shoulder, end);
    return arm;
  }

  int FindToe(int ankle, double leg_length) const {
    const char side = names_[static_cast<std::size_t>(ankle)].side;
    std::vector<BoneKind> kinds = {BoneKind::kToe};
    if (Kind(ankle) == BoneKind::kAnkle) kinds.push_back(BoneKind::kFoot);
    int toe = FindTopmost(kinds, side, ankle);
    for (int j = ankle + 1; j < motion_.num_joints() && toe < 0; ++j) {
      if (Parent(j) == ankle && motion_.names[static_cast<std::size_t>(j)].empty()) toe = j;
    }
    return toe >= 0 && Distance(ankle, toe) > kLeastToe * leg_length ? toe : -1;
  }

  /// Knees bend to the front, and toes are there.
  bool HasExchangedSides(const LimbJoints& left, const LimbJoints& right, double leg_length) const {
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
    return front_sum / count > kLeastFront * leg_length && sum < -0.5 * front_sum;
  }

  const SkeletonMotion& motion_;
  std::vector<BoneName> names_;
  std::vector<Matrix3Xd> frames_;
};

}  // namespace

std::vector<int> SpreadFrames(int num_frames, int most) {
  const int count = std::min(num_frames, most);
  std::vector<int> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(static_cast<int>(static_cast<long>(i) * num_frames / count));
  }
  return frames;
}

FoundBody FindBody(const SkeletonMotion& motion, const BoneNames& names) {
  return BodyFinder(motion, names).Find();
}

}  // namespace mmm_converter
