// SPDX-License-Identifier: MIT
#include "common/calibrate/joint_doubts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/support/units.h"

namespace mmm_converter {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kLeastDoubt = 1 / kDegrees;   // [rad]
constexpr double kTold = 5 / kDegrees;         // [rad]; what goniometers in the clinic tell apart
constexpr double kMostRange = 360 / kDegrees;  // [rad]
constexpr double kLeastExplained = 0.5;
constexpr std::size_t kMostPartners = 4;

/// What of a joint's variance the coordinates from `first` on explain.
double Explained(const MatrixXd& covariance, const VectorXd& of_joint, Index first, Index count) {
  const VectorXd c = of_joint.segment(first, count);
  return c.dot(covariance.block(first, first, count, count).ldlt().solve(c));
}

std::vector<std::string> PartnersOf(const BodyKinematics& kinematics, const MatrixXd& covariance,
                                    const VectorXd& of_joint, double variance) {
  std::vector<std::pair<double, std::string>> partners;
  const auto add = [&](Index first, Index count, const std::string& name) {
    const double share = Explained(covariance, of_joint, first, count) / variance;
    if (share >= kLeastExplained) partners.emplace_back(share, name);
  };
  const KinematicModel& model = kinematics.model();
  const auto markers = static_cast<Index>(kinematics.markers().size());
  for (Index m = 0; m < markers; ++m) {
    add(3 * m, 3, model.markers()[kinematics.markers()[static_cast<std::size_t>(m)]].name);
  }
  const SegmentLengths& lengths = kinematics.lengths();
  const int axes = lengths.are_of_axes ? 3 : 1;
  for (int i = 0; i < static_cast<int>(lengths.segments.size()); i += axes) {
    add(3 * markers + i, axes, model.segments()[lengths.segments[i]].name);
  }
  std::stable_sort(partners.begin(), partners.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> names;
  for (const auto& [share, name] : partners) {
    if (names.size() < kMostPartners) names.push_back(name);
  }
  return names;
}

}  // namespace

std::vector<JointDoubt> FindJointDoubts(const BodyKinematics& kinematics,
                                        const BodyFitResult& fit) {
  const MatrixXd of_joints = fit.covariance * fit.joint_slopes.transpose();  // body x joints
  std::vector<JointDoubt> doubts;
  for (Index j = 0; j < fit.joint_slopes.rows(); ++j) {
    const double variance = fit.joint_slopes.row(j).dot(of_joints.col(j));
    if (!(variance >= kLeastDoubt * kLeastDoubt)) continue;
    // No angle is farther off than anywhere in its range.
    const MarkerKinematics& tracked = kinematics.kinematics();
    const double range = std::min(tracked.upper()[j] - tracked.lower()[j], kMostRange);
    const double deviation = std::min(std::sqrt(variance), range / std::sqrt(12.0));
    const int joint = kinematics.joints()[static_cast<std::size_t>(j)];
    doubts.push_back({kinematics.model().joint(joint).name, deviation,
                      PartnersOf(kinematics, fit.covariance, of_joints.col(j), variance)});
  }
  std::stable_sort(doubts.begin(), doubts.end(), [](const JointDoubt& a, const JointDoubt& b) {
    return a.deviation > b.deviation;
  });
  return doubts;
}

std::vector<std::string> DescribeDoubts(const std::vector<JointDoubt>& doubts) {
  std::vector<std::string> texts;
  for (const JointDoubt& doubt : doubts) {
    if (doubt.deviation < kTold) continue;
    texts.push_back(fmt::format("{} ± {:.0f}°", doubt.joint, kDegrees * doubt.deviation));
    if (doubt.partners.empty()) continue;
    texts.back() += fmt::format(" (with {})", fmt::join(doubt.partners, ", "));
  }
  return texts;
}

void WidenDeviations(const Subject& subject, ConversionResult* result) {
  MatrixXd& deviations = result->trajectory.standard_deviations;
  if (deviations.size() == 0) return;
  const std::vector<std::string>& names = result->trajectory.joint_names;
  VectorXd least = VectorXd::Zero(deviations.rows());
  for (const JointDoubt& doubt : subject.joints) {
    const auto found = std::find(names.begin(), names.end(), doubt.joint);
    if (found != names.end()) least[6 + (found - names.begin())] = doubt.deviation;
  }
  const auto factors = [&](const auto& own) -> VectorXd {
    return (least.array() > own.array() && own.array() > 0).select(least.cwiseQuotient(own), 1.0);
  };
  for (PoseCovariance& one : result->covariances) {
    const VectorXd factor = factors(one.covariance.diagonal().cwiseSqrt().eval());
    one.covariance = factor.asDiagonal() * one.covariance * factor.asDiagonal();
  }
  for (auto own : deviations.colwise()) own.array() *= factors(own.eval()).array();
}

}  // namespace mmm_converter
