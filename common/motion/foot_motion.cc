// SPDX-License-Identifier: MIT
#include "common/motion/foot_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/low_pass.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

// Of a treadmill.
constexpr double kSlowestBelt = 0.15;  // [m/s] belts begin at 0.2
constexpr double kAlike = 0.25;        // [m/s] between velocities of feet that it carries
constexpr double kCarriedShare = 0.3;  // of a low foot's time; who runs hardly stands longer
constexpr double kSameWay = 0.9;       // cosine between the velocities below both feet
constexpr double kMostTravel = 0.5;    // of the belt's speed: persons drift along it
constexpr double kShortestRun = 1.5;   // [s] two strides, at least
constexpr double kSameBelt = 0.1;  // [m/s] from a belt's speed: carried, neither coming nor going
constexpr double kLowFoot = 0.05;  // [m] above where a foot is in a tenth of the time

constexpr double kStillPelvis = 0.01;  // [m] a walker's goes up and down by more

constexpr double kCutoff = 12;  // [Hz] a foot is stopped by the ground within some 50 ms

// Of the distance from the ankle to the joint of the toes: how far the heel lies behind the ankle
// and the tip of the toes before their joint, as on MMM's reference model.
constexpr double kHeelBehind = 0.4;
constexpr double kTipBefore = 0.4;

struct FootSegments {
  // Of MMM's reference model: x right, y forward, z up where it stands.
  int ankle = -1, sole = -1, toes = -1;
  // Of OpenSim's models of persons, whose calcn begins at the heel: x forward.
  int osim_heel = -1, osim_toes = -1;

  bool is_mmm() const { return ankle >= 0 && sole >= 0 && toes >= 0; }
  bool is_osim() const { return osim_heel >= 0 && osim_toes >= 0; }
};

FootSegments SegmentsOf(const KinematicModel& model, Side side) {
  const bool is_left = side == Side::kLeft;
  return {model.FindSegment(is_left ? "LAy_joint" : "RAy_joint"),
          model.FindSegment(is_left ? "LeftFootHeight_joint" : "RightFootHeight_joint"),
          model.FindSegment(is_left ? "LFx_joint" : "RFx_joint"),
          model.FindSegment(is_left ? "calcn_l" : "calcn_r"),
          model.FindSegment(is_left ? "toes_l" : "toes_r")};
}

/// Heel and tip of the toes [m].
std::array<Eigen::Vector3d, 2> EndsOf(const FootSegments& foot,
                                      const std::vector<Eigen::Isometry3d>& X_WS) {
  if (!foot.is_mmm()) {
    const Eigen::Vector3d heel = X_WS[foot.osim_heel].translation();
    const Eigen::Isometry3d& X_WT = X_WS[foot.osim_toes];
    const double length = (X_WT.translation() - heel).norm();
    return {heel, X_WT * Eigen::Vector3d(kTipBefore * length, 0, 0)};
  }
  const Eigen::Isometry3d& X_WA = X_WS[foot.ankle];
  const Eigen::Isometry3d& X_WT = X_WS[foot.toes];
  const double sole = (X_WA.inverse() * X_WS[foot.sole].translation()).z();
  const double toes = (X_WA.inverse() * X_WT.translation()).z();
  const double length = (X_WT.translation() - X_WA.translation()).norm();
  return {X_WA * Eigen::Vector3d(0, -kHeelBehind * length, sole),
          X_WT * Eigen::Vector3d(0, kTipBefore * length, sole - toes)};
}

/// Of the up axis, along W's.
double UprightOf(const FootSegments& foot, const std::vector<Eigen::Isometry3d>& X_WS) {
  return foot.is_mmm() ? X_WS[foot.ankle].linear()(2, 2) : X_WS[foot.osim_heel].linear()(2, 1);
}

/// The centre of mass, or the root of a model without masses [m].
Eigen::Vector3d BodyCentre(const KinematicModel& model,
                           const std::vector<Eigen::Isometry3d>& X_WS) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < X_WS.size(); ++i) {
    const Segment& segment = model.segments()[i];
    moment += segment.mass * (X_WS[i] * segment.p_SB);
    mass += segment.mass;
  }
  return mass > 0 ? Eigen::Vector3d(moment / mass) : Eigen::Vector3d(X_WS[0].translation());
}

/// After a low-pass [m/s].
Eigen::Matrix3Xd VelocityOf(const Eigen::Matrix3Xd& path, double rate) {
  const Eigen::Index frames = path.cols();
  const double cutoff = std::min(kCutoff, LargestCutoff(rate));
  const Eigen::MatrixXd smooth = LowPassed(path.transpose(), rate, cutoff);
  Eigen::Matrix3Xd velocity = Eigen::Matrix3Xd::Zero(3, frames);
  for (Eigen::Index k = 0; k < frames && frames > 1; ++k) {
    const Eigen::Index before = std::max<Eigen::Index>(k - 1, 0);
    const Eigen::Index after = std::min(k + 1, frames - 1);
    velocity.col(k) = (smooth.row(after) - smooth.row(before)).transpose() * rate /
                      static_cast<double>(after - before);
  }
  return velocity;
}

/// The horizontal velocity that most of these are near to, and the share of them that is.
std::pair<Eigen::Vector3d, double> UsualOf(const std::vector<Eigen::Vector3d>& velocities) {
  constexpr std::size_t kMost = 500;  // compared with each other
  const std::size_t step = velocities.size() / kMost + 1;
  std::pair<Eigen::Vector3d, double> usual = {Eigen::Vector3d::Zero(), 0};
  for (std::size_t i = 0; i < velocities.size(); i += step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double near = 0, all = 0;
    for (std::size_t j = 0; j < velocities.size(); j += step) {
      ++all;
      if ((velocities[j] - velocities[i]).norm() > kAlike) continue;
      sum += velocities[j];
      ++near;
    }
    if (near / all > usual.second) usual = {sum / near, near / all};
  }
  for (int i = 0; i < 3; ++i) {
    std::array<std::vector<double>, 2> carried;
    for (const Eigen::Vector3d& one : velocities) {
      if ((one - usual.first).norm() > kSameBelt) continue;
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        carried[static_cast<std::size_t>(axis)].push_back(one[axis]);
      }
    }
    if (!carried[0].empty()) usual.first << Median(carried[0]), Median(carried[1]), 0;
  }
  return usual;
}

/// The lower end of a foot, while it is low.
std::vector<Eigen::Vector3d> LowVelocities(const FootPath& foot, const Eigen::Matrix3Xd& heel,
                                           const Eigen::Matrix3Xd& toe) {
  const Eigen::VectorXd heights = foot.heel.row(2).cwiseMin(foot.toe.row(2));
  const double lowest = Percentile({heights.data(), static_cast<std::size_t>(heights.size())}, 10);
  std::vector<Eigen::Vector3d> velocities;
  for (Eigen::Index k = 0; k < heights.size(); ++k) {
    if (!(heights[k] < lowest + kLowFoot)) continue;
    velocities.emplace_back(foot.heel(2, k) < foot.toe(2, k) ? heel.col(k) : toe.col(k));
    velocities.back().z() = 0;
  }
  return velocities;
}

/// Of the body, or of the middle of both feet: the slope of a straight line [m/s].
Eigen::Vector3d TravelOf(const FootMotion& motion) {
  const Eigen::Index frames = motion.num_frames();
  const Eigen::Matrix3Xd path =
      motion.body.cols() == frames ? motion.body : (motion.feet[0].heel + motion.feet[1].heel) / 2;
  const Eigen::VectorXd times =
      Eigen::VectorXd::LinSpaced(frames, -0.5, 0.5) * static_cast<double>(frames - 1) / motion.rate;
  return path * times / times.squaredNorm();
}

}  // namespace

const char* Name(Side side) { return side == Side::kLeft ? "left" : "right"; }

bool HasFeet(const KinematicModel& model) {
  return std::all_of(kSides.begin(), kSides.end(), [&](Side side) {
    const FootSegments foot = SegmentsOf(model, side);
    return foot.is_mmm() || foot.is_osim();
  });
}

int FootSegment(const KinematicModel& model, Side side) {
  const FootSegments foot = SegmentsOf(model, side);
  return foot.is_mmm() ? foot.sole : foot.osim_heel;
}

FootMotion MoveFeet(const KinematicModel& model, const PoseTrajectory& motion) {
  if (!HasFeet(model)) {
    throw Error(
        "contacts need the feet of MMM's or OpenSim's models, which this one does not have");
  }
  FootMotion moved;
  moved.rate = motion.rate;
  moved.first_time = motion.first_time;
  for (FootPath& foot : moved.feet) {
    foot.heel.resize(3, motion.num_frames());
    foot.toe.resize(3, motion.num_frames());
    foot.upright.resize(motion.num_frames());
  }
  moved.body.resize(3, motion.num_frames());
  const auto pelvis = static_cast<std::size_t>(std::max(0, model.FindSegment("pelvis")));
  Eigen::AlignedBox3d places;  // of the pelvis
  for (int k = 0; k < motion.num_frames(); ++k) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    moved.body.col(k) = BodyCentre(model, X_WS);
    places.extend(X_WS[pelvis].translation());
    for (const Side side : kSides) {
      const FootSegments segments = SegmentsOf(model, side);
      const auto [heel, toe] = EndsOf(segments, X_WS);
      FootPath& path = moved.feet[static_cast<std::size_t>(side)];
      path.heel.col(k) = heel;
      path.toe.col(k) = toe;
      path.upright[k] = UprightOf(segments, X_WS);
    }
  }
  FindSpeeds(&moved);
  // What has no motion in the world goes nowhere, as a person on a treadmill.
  for (FootPath& foot : moved.feet) {
    if (places.diagonal().norm() > kStillPelvis || foot.belt.isZero()) continue;
    foot.belt.setZero();
    foot.heel_speed = VelocityOf(foot.heel, moved.rate).colwise().norm();
    foot.toe_speed = VelocityOf(foot.toe, moved.rate).colwise().norm();
  }
  return moved;
}

void FindSpeeds(FootMotion* motion) {
  std::array<std::array<Eigen::Matrix3Xd, 2>, 2> velocities;
  std::array<std::pair<Eigen::Vector3d, double>, 2> usual;
  for (std::size_t i = 0; i < motion->feet.size(); ++i) {
    FootPath& foot = motion->feet[i];
    velocities[i] = {VelocityOf(foot.heel, motion->rate), VelocityOf(foot.toe, motion->rate)};
    usual[i] = UsualOf(LowVelocities(foot, velocities[i][0], velocities[i][1]));
    foot.belt.setZero();
  }
  const Eigen::Vector3d& left = usual[0].first;
  const Eigen::Vector3d& right = usual[1].first;
  const bool move_alike = left.norm() > kSlowestBelt && right.norm() > kSlowestBelt &&
                          left.dot(right) > kSameWay * left.norm() * right.norm() &&
                          std::min(usual[0].second, usual[1].second) > kCarriedShare;
  const bool is_long = motion->num_frames() > kShortestRun * motion->rate;
  const bool is_treadmill =
      move_alike && is_long &&
      TravelOf(*motion).norm() < kMostTravel * std::min(left.norm(), right.norm());
  for (std::size_t i = 0; i < motion->feet.size(); ++i) {
    FootPath& foot = motion->feet[i];
    if (is_treadmill) foot.belt = usual[i].first;
    foot.heel_speed = (velocities[i][0].colwise() - foot.belt).colwise().norm();
    foot.toe_speed = (velocities[i][1].colwise() - foot.belt).colwise().norm();
  }
}

}  // namespace mmm_converter
