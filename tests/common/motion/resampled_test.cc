// SPDX-License-Identifier: MIT
#include "common/motion/resampled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace mmm_converter {
namespace {

constexpr double kFree = std::numeric_limits<double>::infinity();

JointBounds Bounds(double lower, double upper, double velocity) {
  return {Eigen::VectorXd::Constant(1, lower), Eigen::VectorXd::Constant(1, upper),
          Eigen::VectorXd::Constant(1, velocity)};
}

Posture PostureAt(double t) {
  Posture posture;
  posture.position = Eigen::Vector3d(std::sin(3 * t), t * t, 1);
  posture.orientation = Eigen::AngleAxisd(std::sin(4 * t), Eigen::Vector3d(1, 2, 2) / 3);
  posture.joint_angles = Eigen::VectorXd::Constant(1, std::cos(5 * t));
  return posture;
}

PoseTrajectory Smooth(double rate, int frames) {
  PoseTrajectory motion;
  motion.rate = rate;
  motion.first_time = 0.25;
  motion.joint_names = {"j"};
  for (int k = 0; k < frames; ++k) motion.postures.push_back(PostureAt(k / rate));
  return motion;
}

TEST(Resampled, FramesStayWhereTheyAre) {
  const PoseTrajectory motion = Smooth(100, 101);
  const PoseTrajectory half = Resample(motion, 50, Bounds(-kFree, kFree, kFree));
  ASSERT_EQ(half.num_frames(), 51);
  EXPECT_EQ(half.first_time, 0.25);
  for (int k = 0; k < 51; ++k) {
    EXPECT_EQ(half.postures[k].position, motion.postures[2 * k].position);
    EXPECT_EQ(half.postures[k].orientation.coeffs(), motion.postures[2 * k].orientation.coeffs());
    EXPECT_EQ(half.postures[k].joint_angles, motion.postures[2 * k].joint_angles);
  }
}

TEST(Resampled, BetweenFramesItIsAccurate) {
  const PoseTrajectory motion = Smooth(100, 101);
  for (const double rate : {30.0, 29.97, 50.0, 120.0, 240.0}) {
    const PoseTrajectory other = Resample(motion, rate, Bounds(-kFree, kFree, kFree));
    EXPECT_EQ(other.num_frames(), static_cast<int>(rate * 1.0 + 1e-9) + 1);
    double worst = 0;
    for (int k = 0; k < other.num_frames(); ++k) {
      if (k / rate < 0.01 || k / rate > 0.99) continue;  // the ends have slopes of one side
      const Posture truth = PostureAt(k / rate);
      worst = std::max(worst, Local(other.postures[k], truth).cwiseAbs().maxCoeff());
      EXPECT_NEAR(other.postures[k].orientation.norm(), 1, 1e-15);
    }
    EXPECT_LT(worst, 5e-6) << rate;  // (5/s)^3 (10 ms)^3 / 24, its error's leading term
  }
}

TEST(Resampled, KeepsLimitsOfPositionAndVelocity) {
  PoseTrajectory motion = Smooth(100, 6);
  const double angles[] = {0, 0, 0.02, 0.04, 0.04, 0.04};  // 2 rad/s, and a stop at 0.04
  for (int k = 0; k < 6; ++k) motion.postures[k].joint_angles[0] = angles[k];
  const PoseTrajectory fine = Resample(motion, 1000, Bounds(0, 0.04, 2));
  for (int k = 0; k < fine.num_frames(); ++k) {
    const double q = fine.postures[k].joint_angles[0];
    EXPECT_GE(q, 0);
    EXPECT_LE(q, 0.04);
    const double before = fine.postures[std::max(k - 1, 0)].joint_angles[0];
    EXPECT_LE(std::abs(q - before), 2e-3 * (1 + 1e-9));
  }
}

TEST(Resampled, OneFrameStaysOne) {
  EXPECT_EQ(Resample(Smooth(100, 1), 30, Bounds(-1, 1, 1)).num_frames(), 1);
  EXPECT_EQ(Resample(Smooth(100, 0), 30, Bounds(-1, 1, 1)).num_frames(), 0);
}

}  // namespace
}  // namespace mmm_converter
