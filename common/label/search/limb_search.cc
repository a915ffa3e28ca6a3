// SPDX-License-Identifier: MIT
#include "common/label/search/limb_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/label/tuning.h"
#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::Ref;

void RandomizeJoints(const MarkerKinematics& kinematics, const std::vector<int>& joints,
                     bool may_stay_near, SeededRandom* random, Posture* posture) {
  const bool is_whole = random->Uniform() < LimbTuning::kAllJointsShare;
  const bool is_near = may_stay_near && random->Uniform() < LimbTuning::kNearbyShare;
  for (std::size_t i = is_whole ? 0 : joints.size() / 2; i < joints.size(); ++i) {
    const int j = joints[i];
    const auto [lower, upper] = kinematics.Range(j);
    double& angle = posture->joint_angles[j];
    angle = is_near ? angle + LimbTuning::kNearby * random->Normal()
                    : lower + random->Uniform() * (upper - lower);
    angle = std::clamp(angle, lower, upper);
  }
}

LimbSearch::LimbSearch(const LabelBody& body)
    : body_(body), at_(body.kinematics.MakeJacobian()), moving_(body) {}

void LimbSearch::ComputeExcess(const Ref<const Matrix3Xd>& points, const BodyMatch& match) {
  std::vector<char> is_used(static_cast<std::size_t>(points.cols()), 0);
  for (const int point : match.point_of_marker) {
    if (point >= 0) is_used[point] = 1;
  }
  excess_.setZero(body_.num_markers());
  body_.kinematics.ComputeMarkers(match.posture.position,
                                  match.posture.orientation.toRotationMatrix(),
                                  match.posture.joint_angles, &at_);
  found_ = at_.p_WM;
  for (int m = 0; m < body_.num_markers(); ++m) {
    const int point = match.point_of_marker[m];
    if (point >= 0) {
      const double v =
          body_.place[m] * body_.place[m] + MatchCosts::kSettled * MatchCosts::kSettled;
      excess_[m] = std::max(
          (points.col(point) - at_.p_WM.col(m)).squaredNorm() / v - MatchCosts::kGood, 0.0);
      continue;
    }
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      if (is_used[p] == 0 && (points.col(p) - at_.p_WM.col(m)).norm() < LimbTuning::kReach) {
        excess_[m] = MatchCosts::kUnmatched;
        break;
      }
    }
  }
}

const LabelBody::Limb* LimbSearch::ChooseLimb(SeededRandom* random) const {
  if (random->Uniform() < LimbTuning::kAnyShare) {
    return &body_.limbs[random->UniformIndex(static_cast<int>(body_.limbs.size()))];
  }
  const int limb = body_.limb_of_marker[IndexAtShare(random->Uniform(), excess_)];
  return limb < 0 ? nullptr : &body_.limbs[limb];
}

const LabelBody::Limb* LimbSearch::LimbBeside(const LabelBody::Limb& limb) const {
  const LabelBody::Limb* beside = nullptr;
  double nearest = LimbTuning::kBeside;
  for (const LabelBody::Limb& other : body_.limbs) {
    if (&other == &limb) continue;
    for (const int m : other.markers) {
      const double distance =
          (found_(Eigen::all, limb.markers).colwise() - found_.col(m)).colwise().norm().minCoeff();
      if (distance >= nearest) continue;
      nearest = distance;
      beside = &other;
    }
  }
  return beside;
}

bool LimbSearch::IsNearerToRoot(int marker, int other) const {
  const std::vector<int>& joints = body_.joints_of_marker[marker];
  return std::all_of(joints.begin(), joints.end(),
                     [&](int j) { return body_.kinematics.Moves(j, other); });
}

bool LimbSearch::PutOnTwoPoints(const LabelBody::Limb& limb, SeededRandom* random,
                                Posture* posture) {
  const auto markers = static_cast<int>(limb.markers.size());
  const auto link = [&](int i) { return body_.kinematics.link_of_marker(limb.markers[i]); };
  const int first = random->UniformIndex(markers);
  mates_.clear();
  for (int i = 0; i < markers; ++i) {
    if (i != first && link(i) == link(first)) mates_.push_back(i);
  }
  if (mates_.empty()) return false;
  const int second = mates_[random->UniformIndex(static_cast<int>(mates_.size()))];
  const Matrix3Xd& places = moving_.Place(*posture);
  const double between = (places.col(first) - places.col(second)).norm();
  point_pairs_.clear();
  for (int p = 0; p < points_.cols(); ++p) {
    if ((points_.col(p) - places.col(first)).norm() > LimbTuning::kReach) continue;
    for (int q = 0; q < points_.cols(); ++q) {
      const double distance = (points_.col(p) - points_.col(q)).norm();
      if (q != p && std::abs(distance - between) < LimbTuning::kAsFar)
        point_pairs_.emplace_back(p, q);
    }
  }
  if (point_pairs_.empty()) return false;
  const auto [p, q] = point_pairs_[random->UniformIndex(static_cast<int>(point_pairs_.size()))];
  noise_ = body_.place(limb.markers);
  targets_.setConstant(3, markers, kNaN);
  const bool holds = random->Uniform() < LimbTuning::kHeldShare;
  for (int i = 0; holds && i < markers; ++i) {
    const int point = fit_.point_of_marker()[i];
    if (point < 0 || point == p || point == q || link(i) == link(first)) continue;
    if (IsNearerToRoot(limb.markers[i], limb.markers[first])) targets_.col(i) = points_.col(point);
  }
  targets_.col(first) = points_.col(p);
  targets_.col(second) = points_.col(q);
  angles_ = posture->joint_angles;  // joints that these points do not move stay
  for (int i = 0; i < LimbTuning::kTwoPointsSteps; ++i) {
    moving_.Place(*posture);
    moving_.StepAbout(angles_, targets_, noise_, posture);
  }
  return true;
}

double LimbSearch::Settle(int most_turns, Posture* posture) {
  return fit_.Settle(points_, {MatchCosts::kSettled, most_turns, false}, &moving_, posture);
}

void LimbSearch::LeavePoints(const Ref<const Matrix3Xd>& points, const BodyMatch& match,
                             const LabelBody::Limb& limb) {
  std::vector<char> is_taken(static_cast<std::size_t>(points.cols()), 0);
  for (const int point : match.point_of_marker) {
    if (point >= 0) is_taken[point] = 1;
  }
  for (const int m : limb.markers) {
    if (match.point_of_marker[m] >= 0) is_taken[match.point_of_marker[m]] = 0;
  }
  left_.clear();
  for (int p = 0; p < points.cols(); ++p) {
    if (is_taken[p] == 0) left_.push_back(p);
  }
  points_ = points(Eigen::all, left_);
}

bool LimbSearch::Improve(const Ref<const Matrix3Xd>& points, int tries, SeededRandom* random,
                         BodyMatch* match) {
  bool is_better = false;
  ComputeExcess(points, *match);
  Posture trial;
  for (int i = 0; i < tries && excess_.sum() > LimbTuning::kLeastGain; ++i) {
    const LabelBody::Limb* const first = ChooseLimb(random);
    if (first == nullptr) continue;
    const LabelBody::Limb* limb = first;
    const LabelBody::Limb* const second =
        random->Uniform() < LimbTuning::kPairShare ? LimbBeside(*first) : nullptr;
    if (second != nullptr) {
      pair_ = *first;
      pair_.joints.insert(pair_.joints.end(), second->joints.begin(), second->joints.end());
      pair_.markers.insert(pair_.markers.end(), second->markers.begin(), second->markers.end());
      limb = &pair_;
    }
    LeavePoints(points, *match, *limb);
    moving_.Choose(*limb);
    trial = match->posture;
    const double before = Settle(0, &trial);
    if (random->Uniform() >= LimbTuning::kTwoPointsShare ||
        !PutOnTwoPoints(*limb, random, &trial)) {
      RandomizeJoints(body_.kinematics, first->joints, true, random, &trial);
      if (second != nullptr) {
        RandomizeJoints(body_.kinematics, second->joints, true, random, &trial);
      }
      fit_.Anneal(points_, LimbTuning::kAnnealing, &moving_, &trial);
    }
    const double after = Settle(LimbTuning::kMostTurns, &trial);
    if (after > before - LimbTuning::kLeastGain) continue;
    is_better = true;
    match->posture = trial;
    match->cost -= before - after;
    for (std::size_t m = 0; m < limb->markers.size(); ++m) {
      const int point = fit_.point_of_marker()[m];
      match->point_of_marker[limb->markers[m]] = point < 0 ? -1 : left_[point];
    }
    ComputeExcess(points, *match);
  }
  return is_better;
}

}  // namespace mmm_converter
