// SPDX-License-Identifier: MIT
#include "common/contacts/foot_motion.h"

#include <algorithm>

#include "common/model/forward_kinematics.h"
#include "common/motion/low_pass.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

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

Eigen::VectorXd SpeedOf(const Eigen::Matrix3Xd& path, double rate) {
  const Eigen::Index frames = path.cols();
  const double cutoff = std::min(kCutoff, LargestCutoff(rate));
  const Eigen::MatrixXd smooth = LowPassed(path.transpose(), rate, cutoff);
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(frames);
  for (Eigen::Index k = 0; k < frames && frames > 1; ++k) {
    const Eigen::Index before = std::max<Eigen::Index>(k - 1, 0);
    const Eigen::Index after = std::min(k + 1, frames - 1);
    speed[k] = (smooth.row(after) - smooth.row(before)).norm() * rate /
               static_cast<double>(after - before);
  }
  return speed;
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
  }
  for (int k = 0; k < motion.num_frames(); ++k) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    for (const Side side : kSides) {
      const auto [heel, toe] = EndsOf(SegmentsOf(model, side), X_WS);
      FootPath& path = moved.feet[static_cast<std::size_t>(side)];
      path.heel.col(k) = heel;
      path.toe.col(k) = toe;
    }
  }
  for (FootPath& foot : moved.feet) {
    foot.heel_speed = SpeedOf(foot.heel, motion.rate);
    foot.toe_speed = SpeedOf(foot.toe, motion.rate);
  }
  return moved;
}

}  // namespace mmm_converter
