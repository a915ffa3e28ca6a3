// SPDX-License-Identifier: MIT
#include "common/retarget/trajectory_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "common/model/forward_kinematics.h"
#include "common/retarget/block_band.h"
#include "common/retarget/segment_jacobian.h"
#include "tests/common/retarget/biped.h"

namespace mmm_converter {
namespace {

using testing::MakeBiped;

TEST(BlockBandTest, SolvesAsADenseMatrixDoes) {
  constexpr int kFrames = 7, kSize = 4;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  BlockBand band;
  band.Resize(kFrames, kSize);
  band.SetZero();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kFrames * kSize, kFrames * kSize);
  Eigen::VectorXd right(kFrames * kSize);
  const auto draw = [&](auto* values) {
    for (double& value : values->reshaped()) value = normal(random);
  };
  for (int k = 0; k < kFrames; ++k) {
    Eigen::MatrixXd A(kSize, kSize);
    draw(&A);
    band.diagonal[k] = A * A.transpose() + 20 * Eigen::MatrixXd::Identity(kSize, kSize);
    dense.block<kSize, kSize>(k * kSize, k * kSize) = band.diagonal[k];
    draw(&band.right[k]);
    right.segment<kSize>(k * kSize) = band.right[k];
    for (int back = 1; back <= std::min(k, 2); ++back) {
      Eigen::VectorXd& side = back == 1 ? band.before[k] : band.before2[k];
      draw(&side);
      dense.block<kSize, kSize>(k * kSize, (k - back) * kSize) = side.asDiagonal();
      dense.block<kSize, kSize>((k - back) * kSize, k * kSize) = side.asDiagonal();
    }
  }
  const Eigen::VectorXd expected = dense.llt().solve(right);
  ASSERT_TRUE(SolveInPlace(&band));
  for (int k = 0; k < kFrames; ++k) {
    EXPECT_TRUE(band.right[k].isApprox(expected.segment<kSize>(k * kSize), 1e-10)) << k;
  }
}

TEST(SegmentJacobianTest, IsTheDifferenceQuotient) {
  const Robot robot = MakeBiped({});
  Posture posture = ZeroPosture(robot.model);
  posture.position = {0.3, -0.2, 0.9};
  posture.orientation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  for (int j = 0; j < robot.model.num_joints(); ++j) posture.joint_angles[j] = 0.1 + 0.05 * j;
  SegmentJacobian jacobian(robot.model);
  jacobian.Compute(posture);
  const int foot = robot.model.FindSegment("right_ankle_roll");
  const Eigen::Vector3d p_S(0.1, 0.02, -0.08), d_S = p_S.normalized();
  const Eigen::Isometry3d X = SegmentPoses(robot.model, posture)[foot];
  ASSERT_TRUE(jacobian.X_WS(foot).isApprox(X, 1e-12));
  SegmentJacobian::Rows of_point, of_direction;
  jacobian.OfPoint(foot, X * p_S, &of_point);
  jacobian.OfDirection(foot, X.linear() * d_S, &of_direction);
  const std::vector<int>& columns = jacobian.columns(foot);
  EXPECT_EQ(columns.size(), 12U);  // the root's and those of the leg
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(6 + robot.model.num_joints());
    step[columns[i]] = kStep;
    const Eigen::Isometry3d after = SegmentPoses(robot.model, Retract(posture, step))[foot];
    const Eigen::Isometry3d before = SegmentPoses(robot.model, Retract(posture, -step))[foot];
    const Eigen::Vector3d moved = (after * p_S - before * p_S) / (2 * kStep);
    const Eigen::Vector3d turned = (after.linear() - before.linear()) * d_S / (2 * kStep);
    const auto column = static_cast<Eigen::Index>(i);
    EXPECT_NEAR((of_point.col(column) - moved).norm(), 0, 1e-8);  // of central differences
    EXPECT_NEAR((of_direction.col(column) - turned).norm(), 0, 1e-8);
  }
}

/// The left arm swings by 1 rad within 0.1 s, as far as its shoulder allows.
TrajectoryProblem SwingArm(const Robot& robot, int frames) {
  TrajectoryProblem problem;
  problem.model = &robot.model;
  problem.rate = 100;
  problem.num_frames = frames;
  problem.velocity_limits = robot.velocity_limits;
  problem.rest = ZeroPosture(robot.model).joint_angles;
  const int arm = robot.model.FindSegment("left_shoulder_yaw");
  Aim aim{arm, true, -Eigen::Vector3d::UnitZ(), Eigen::Matrix3Xd(3, frames),
          Eigen::Matrix3Xd::Constant(3, frames, 20)};
  Aim root{0, false, Eigen::Vector3d::Zero(), Eigen::Matrix3Xd::Zero(3, frames),
           Eigen::Matrix3Xd::Constant(3, frames, 100)};
  Aim up{0, true, Eigen::Vector3d::UnitZ(), Eigen::Matrix3Xd::Zero(3, frames),
         Eigen::Matrix3Xd::Constant(3, frames, 100)};
  Aim ahead{0, true, Eigen::Vector3d::UnitX(), Eigen::Matrix3Xd::Zero(3, frames),
            Eigen::Matrix3Xd::Constant(3, frames, 100)};
  up.target.row(2).setOnes();
  ahead.target.row(0).setOnes();
  for (int k = 0; k < frames; ++k) {
    const double angle = std::clamp((k - 0.5 * frames) / 10.0, 0.0, 1.0);
    aim.target.col(k) = Eigen::Vector3d(std::sin(angle), 0, -std::cos(angle));
  }
  problem.aims = {aim, root, up, ahead};
  return problem;
}

TEST(TrajectoryFitTest, VelocityLimitsHoldAndTheAimsAreReachedBesides) {
  const Robot robot = MakeBiped({});
  TrajectoryProblem problem = SwingArm(robot, 200);
  problem.velocity_limits.setConstant(5);
  const FitResult fit =
      FitTrajectory(problem, StartTrajectory(problem, ZeroPosture(robot.model)), 4);
  EXPECT_TRUE(fit.has_converged);
  const int shoulder = robot.model.FindJoint("left_shoulder_pitch");
  double fastest = 0;
  for (int k = 1; k < 200; ++k) {
    const Eigen::VectorXd step = fit.postures[k].joint_angles - fit.postures[k - 1].joint_angles;
    fastest = std::max(fastest, step.cwiseAbs().maxCoeff() * problem.rate);
  }
  EXPECT_LE(fastest, 5);
  EXPECT_GT(fastest, 4.8);  // the limit is used
  EXPECT_NEAR(fit.postures.back().joint_angles[shoulder], -1, 0.01);
  EXPECT_NEAR(fit.postures.front().joint_angles[shoulder], 0, 0.01);
}

TEST(TrajectoryFitTest, WindowsJoinAsIfTheyWereOne) {
  const Robot robot = MakeBiped({});
  // Far from the swing, in the middle of 1400 frames, a part of it alone has the same answer.
  const TrajectoryProblem all = SwingArm(robot, 1400);
  TrajectoryProblem part = all;
  part.num_frames = 400;
  for (Aim& aim : part.aims) {
    aim.target = Eigen::Matrix3Xd(aim.target.middleCols(500, 400));
    aim.weight = Eigen::Matrix3Xd(aim.weight.middleCols(500, 400));
  }
  const Posture zero = ZeroPosture(robot.model);
  const FitResult whole = FitTrajectory(all, StartTrajectory(all, zero), 5);
  const FitResult middle = FitTrajectory(part, StartTrajectory(part, zero), 5);
  for (int k = 100; k < 300; ++k) {
    const Eigen::VectorXd difference =
        whole.postures[500 + k].joint_angles - middle.postures[k].joint_angles;
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 2e-3) << k;
  }
}

}  // namespace
}  // namespace mmm_converter
