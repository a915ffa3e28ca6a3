// SPDX-License-Identifier: MIT
#include "common/label/search/limb_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Of a thrown limb: spread [m] and steps.
constexpr double kThrownFrom = 0.12;
constexpr double kThrownTo = 0.03;
constexpr int kThrownSteps = 8;
constexpr double kNearThrow = 0.5;  // [rad]
constexpr double kReach = 0.5;      // [m]: free points farther off are not a marker's
constexpr double kBeside = 0.25;  // [m] between markers of limbs that may have each other's points
constexpr double kPairShare = 0.4;    // of the throws, where limbs are beside each other
constexpr double kToPairShare = 0.8;  // of the tries, where two points are as far as two markers
constexpr double kAnyShare = 0.5;     // of the throws: of any limb, however well it matches
constexpr double kHeldShare = 0.5;    // of the tries with two points: what is nearer to the root
constexpr double kLimbStep = 0.6;     // longest [rad]
constexpr double kLimbDamping = 0.01;
constexpr double kLimbGain = 1;

}  // namespace

LimbSearch::LimbSearch(const LabelBody& body) : body_(body), at_(body.kinematics.MakeJacobian()) {}

void LimbSearch::Excess(const Ref<const Matrix3Xd>& points, const BodyMatch& match) {
  constexpr double kGood = 3;
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
      excess_[m] = std::max((points.col(point) - at_.p_WM.col(m)).squaredNorm() / v - kGood, 0.0);
      continue;
    }
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      if (is_used[p] == 0 && (points.col(p) - at_.p_WM.col(m)).norm() < kReach) {
        excess_[m] = MatchCosts::kUnmatched;
        break;
      }
    }
  }
}

const LabelBody::Limb* LimbSearch::DrawLimb(SeededRandom* random) const {
  if (random->Uniform() < kAnyShare) {
    return &body_.limbs[random->UniformIndex(static_cast<int>(body_.limbs.size()))];
  }
  const int limb = body_.limb_of_marker[IndexAtShare(random->Uniform(), excess_)];
  return limb < 0 ? nullptr : &body_.limbs[limb];
}

const LabelBody::Limb* LimbSearch::LimbBeside(const LabelBody::Limb& limb) const {
  const LabelBody::Limb* beside = nullptr;
  double nearest = kBeside;
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

void LimbSearch::Throw(const LabelBody::Limb& limb, SeededRandom* random, Posture* posture) const {
  // The outer half of the chain, or all of it; anywhere, or nearby.
  const std::size_t first = random->Uniform() < 0.5 ? 0 : limb.joints.size() / 2;
  const bool is_near = random->Uniform() < 0.5;
  for (std::size_t i = first; i < limb.joints.size(); ++i) {
    const int j = limb.joints[i];
    const auto [lower, upper] = body_.kinematics.Range(j);
    double& angle = posture->joint_angles[j];
    angle = is_near ? angle + kNearThrow * random->Normal()
                    : lower + random->Uniform() * (upper - lower);
    angle = std::clamp(angle, lower, upper);
  }
}

void LimbSearch::Place(const LabelBody::Limb& limb, const Posture& posture) {
  body_.kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                                  posture.joint_angles, &at_);
  places_ = at_.p_WM(Eigen::all, limb.markers);
}

void LimbSearch::Step(const LabelBody::Limb& limb, const VectorXd& usual, Posture* posture) {
  const auto joints = static_cast<Eigen::Index>(limb.joints.size());
  body_.kinematics.ComputeJacobian(&at_);
  const auto J_transposed = at_.J_transposed.view();
  H_.setZero(joints, joints);
  g_.setZero(joints);
  J_.resize(joints, 3);
  for (std::size_t i = 0; i < limb.markers.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Vector3d r = targets_.col(column) - places_.col(column);
    if (!r.allFinite()) continue;
    const double weight = 1 / (noise_[column] * noise_[column]);
    for (Eigen::Index j = 0; j < joints; ++j) {
      J_.row(j) = J_transposed.block<1, 3>(6 + limb.joints[j], 3 * limb.markers[i]);
    }
    H_.noalias() += weight * J_ * J_.transpose();
    g_.noalias() += weight * J_ * r;
  }
  for (Eigen::Index j = 0; j < joints; ++j) {
    const int joint = limb.joints[j];
    const double angle = posture->joint_angles[joint];
    H_(j, j) += MatchCosts::kNaturalWeight;
    g_[j] += MatchCosts::kNaturalWeight * (usual[joint] - angle);
    const bool is_pressing = (angle <= body_.kinematics.lower()[joint] && g_[j] < 0) ||
                             (angle >= body_.kinematics.upper()[joint] && g_[j] > 0);
    if (is_pressing) {
      H_.row(j).setZero();
      H_.col(j).setZero();
      H_(j, j) = 1;
      g_[j] = 0;
    }
    H_(j, j) *= 1 + kLimbDamping;
  }
  const Eigen::LLT<Ref<MatrixXd>> factor(H_);
  factor.solveInPlace(g_);
  const double longest = g_.lpNorm<Eigen::Infinity>();
  const double share = longest > kLimbStep ? kLimbStep / longest : 1;
  for (Eigen::Index j = 0; j < joints; ++j) {
    const int joint = limb.joints[j];
    posture->joint_angles[joint] =
        std::clamp(posture->joint_angles[joint] + share * g_[j], body_.kinematics.lower()[joint],
                   body_.kinematics.upper()[joint]);
  }
}

void LimbSearch::Draw(const LabelBody::Limb& limb, Posture* posture) {
  for (int i = 0; i < kThrownSteps; ++i) {
    const double spread = kThrownFrom * std::pow(kThrownTo / kThrownFrom, i / (kThrownSteps - 1.0));
    variances_ = body_.place(limb.markers).array().square() + spread * spread;
    Place(limb, *posture);
    soft_.Compute(places_, variances_, points_);
    targets_ = soft_.targets();
    noise_ = (variances_.array() / soft_.weights().array().max(1e-9)).sqrt();
    Step(limb, body_.natural_angles, posture);
  }
}

bool LimbSearch::DrawToPair(const LabelBody::Limb& limb, SeededRandom* random, Posture* posture) {
  constexpr int kSteps = 6;
  constexpr double kAsFar = 0.02;  // [m]
  const auto markers = static_cast<int>(limb.markers.size());
  const auto link = [&](int i) { return body_.kinematics.link_of_marker(limb.markers[i]); };
  const int first = random->UniformIndex(markers);
  mates_.clear();
  for (int i = 0; i < markers; ++i) {
    if (i != first && link(i) == link(first)) mates_.push_back(i);
  }
  if (mates_.empty()) return false;
  const int second = mates_[random->UniformIndex(static_cast<int>(mates_.size()))];
  Place(limb, *posture);
  const double between = (places_.col(first) - places_.col(second)).norm();
  point_pairs_.clear();
  for (int p = 0; p < points_.cols(); ++p) {
    if ((points_.col(p) - places_.col(first)).norm() > kReach) continue;
    for (int q = 0; q < points_.cols(); ++q) {
      const double distance = (points_.col(p) - points_.col(q)).norm();
      if (q != p && std::abs(distance - between) < kAsFar) point_pairs_.emplace_back(p, q);
    }
  }
  if (point_pairs_.empty()) return false;
  const auto [p, q] = point_pairs_[random->UniformIndex(static_cast<int>(point_pairs_.size()))];
  noise_ = body_.place(limb.markers);
  targets_.setConstant(3, markers, kNaN);
  const bool holds = random->Uniform() < kHeldShare;
  for (int i = 0; holds && i < markers; ++i) {
    const int point = assigned_[i];
    if (point < 0 || point == p || point == q || link(i) == link(first)) continue;
    if (IsNearerToRoot(limb.markers[i], limb.markers[first])) targets_.col(i) = points_.col(point);
  }
  targets_.col(first) = points_.col(p);
  targets_.col(second) = points_.col(q);
  angles_ = posture->joint_angles;  // joints that these points do not move stay
  for (int i = 0; i < kSteps; ++i) {
    Place(limb, *posture);
    Step(limb, angles_, posture);
  }
  return true;
}

double LimbSearch::Settle(const LabelBody::Limb& limb, int turns, Posture* posture) {
  constexpr double kLeastGain = 0.1;
  const auto markers = static_cast<Eigen::Index>(limb.markers.size());
  double best = -1;
  for (int turn = 0;; ++turn) {
    Place(limb, *posture);
    noise_ =
        (body_.place(limb.markers).array().square() + MatchCosts::kSettled * MatchCosts::kSettled)
            .sqrt();
    cost_.resize(markers, points_.cols());
    for (Eigen::Index m = 0; m < markers; ++m) {
      cost_.row(m) =
          (points_.colwise() - places_.col(m)).colwise().squaredNorm() / (noise_[m] * noise_[m]);
    }
    assigned_ = assignment_.Solve(cost_, MatchCosts::kUnmatched);
    const double cost =
        assignment_.cost() +
        MatchCosts::kNaturalWeight *
            (posture->joint_angles(limb.joints) - body_.natural_angles(limb.joints)).squaredNorm();
    if (turn >= turns || (best >= 0 && cost > best - kLeastGain)) return cost;
    best = cost;
    targets_.setConstant(3, markers, kNaN);
    for (Eigen::Index m = 0; m < markers; ++m) {
      if (assigned_[m] >= 0) targets_.col(m) = points_.col(assigned_[m]);
    }
    Step(limb, body_.natural_angles, posture);
  }
}

bool LimbSearch::Improve(const Ref<const Matrix3Xd>& points, int attempts, SeededRandom* random,
                         BodyMatch* match) {
  constexpr int kTurns = 4;
  bool is_better = false;
  Excess(points, *match);
  Posture trial;
  for (int i = 0; i < attempts && excess_.sum() > kLimbGain; ++i) {
    const LabelBody::Limb* const first = DrawLimb(random);
    if (first == nullptr) continue;
    const LabelBody::Limb* limb = first;
    const LabelBody::Limb* const second =
        random->Uniform() < kPairShare ? LimbBeside(*first) : nullptr;
    if (second != nullptr) {
      pair_ = *first;
      pair_.joints.insert(pair_.joints.end(), second->joints.begin(), second->joints.end());
      pair_.markers.insert(pair_.markers.end(), second->markers.begin(), second->markers.end());
      limb = &pair_;
    }
    std::vector<char> is_taken(static_cast<std::size_t>(points.cols()), 0);
    for (const int point : match->point_of_marker) {
      if (point >= 0) is_taken[point] = 1;
    }
    for (const int m : limb->markers) {
      if (match->point_of_marker[m] >= 0) is_taken[match->point_of_marker[m]] = 0;
    }
    allowed_.clear();
    for (int p = 0; p < points.cols(); ++p) {
      if (is_taken[p] == 0) allowed_.push_back(p);
    }
    points_ = points(Eigen::all, allowed_);
    trial = match->posture;
    const double before = Settle(*limb, 0, &trial);
    if (random->Uniform() >= kToPairShare || !DrawToPair(*limb, random, &trial)) {
      Throw(*first, random, &trial);
      if (second != nullptr) Throw(*second, random, &trial);
      Draw(*limb, &trial);
    }
    const double after = Settle(*limb, kTurns, &trial);
    if (after > before - kLimbGain) continue;
    is_better = true;
    match->posture = trial;
    match->cost -= before - after;
    for (std::size_t m = 0; m < limb->markers.size(); ++m) {
      match->point_of_marker[limb->markers[m]] = assigned_[m] < 0 ? -1 : allowed_[assigned_[m]];
    }
    Excess(points, *match);
  }
  return is_better;
}

}  // namespace mmm_converter
