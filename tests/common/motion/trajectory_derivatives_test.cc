// SPDX-License-Identifier: MIT
#include "common/motion/trajectory_derivatives.h"

#include <gtest/gtest.h>

#include "common/math/rotation.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 100;
// Second differences of numbers of about 10 that are rounded at 1e-16 of them, times kRate^2.
constexpr double kRounding = 1e-10;

/// Constant linear, angular and joint accelerations; the axis of rotation stands still in W.
PoseTrajectory Accelerated(int frames) {
  PoseTrajectory motion;
  motion.rate = kRate;
  motion.joint_names = {"a_joint", "b_joint"};
  const Eigen::Quaterniond start = Exp({0.5, -1.0, 0.3});
  for (int k = 0; k < frames; ++k) {
    const double t = k / kRate;
    Posture q;
    q.position = Vector3d(1, 2, 3) + t * Vector3d(0.5, 0, -1) + t * t * Vector3d(1, -2, 0.5);
    q.orientation = Exp((2 * t + 1.5 * t * t) * Vector3d(0.6, 0, 0.8)) * start;
    q.joint_angles = Eigen::Vector2d(0.1 - 3 * t + 2 * t * t, 0.4);
    motion.postures.push_back(q);
  }
  return motion;
}

TEST(TrajectoryDerivativesTest, AreExactForConstantAccelerations) {
  PoseTrajectory motion = Accelerated(30);
  Differentiate(&motion);
  ASSERT_EQ(motion.velocities.rows(), 8);
  ASSERT_EQ(motion.velocities.cols(), 30);
  for (int k = 0; k < 30; ++k) {
    const double t = k / kRate;
    Eigen::VectorXd velocity(8);
    velocity << Vector3d(0.5, 0, -1) + 2 * t * Vector3d(1, -2, 0.5),
        (2 + 3 * t) * Vector3d(0.6, 0, 0.8), -3 + 4 * t, 0;
    Eigen::VectorXd acceleration(8);
    acceleration << 2 * Vector3d(1, -2, 0.5), 3 * Vector3d(0.6, 0, 0.8), 4, 0;
    EXPECT_LT((motion.velocities.col(k) - velocity).norm(), kRounding) << "frame " << k;
    EXPECT_LT((motion.accelerations.col(k) - acceleration).norm(), kRounding) << "frame " << k;
  }
}

TEST(TrajectoryDerivativesTest, FewFrames) {
  PoseTrajectory one = Accelerated(1);
  Differentiate(&one);
  EXPECT_EQ(one.velocities, Eigen::MatrixXd::Zero(8, 1));
  PoseTrajectory two = Accelerated(2);
  Differentiate(&two);
  EXPECT_NEAR(two.velocities(6, 0), -3 + 2 / kRate, kRounding);
  EXPECT_EQ(two.velocities.col(0), two.velocities.col(1));
  EXPECT_EQ(two.accelerations, Eigen::MatrixXd::Zero(8, 2));
}

}  // namespace
}  // namespace mmm_converter
