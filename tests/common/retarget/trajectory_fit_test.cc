// SPDX-License-Identifier: MIT
#include "common/retarget/trajectory_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "common/model/forward_kinematics.h"
#include "common/retarget/block_band.h"
#include "common/retarget/segment_jacobian.h"
#include "common/retarget/trajectory_limits.h"
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

/// The left arm swings by `most` within 0.1 s; weight: of its direction [1/rad].
TrajectoryProblem SwingArm(const Robot& robot, int frames, double most = 1, double weight = 20) {
  TrajectoryProblem problem;
  problem.model = &robot.model;
  problem.rate = 100;
  problem.num_frames = frames;
  problem.velocity_limits = robot.velocity_limits;
  problem.rest = ZeroPosture(robot.model).joint_angles;
  const int arm = robot.model.FindSegment("left_shoulder_yaw");
  Aim aim{arm, true, -Eigen::Vector3d::UnitZ(), Eigen::Matrix3Xd(3, frames),
          Eigen::Matrix3Xd::Constant(3, frames, weight)};
  Aim root{0, false, Eigen::Vector3d::Zero(), Eigen::Matrix3Xd::Zero(3, frames),
           Eigen::Matrix3Xd::Constant(3, frames, 100)};
  Aim up{0, true, Eigen::Vector3d::UnitZ(), Eigen::Matrix3Xd::Zero(3, frames),
         Eigen::Matrix3Xd::Constant(3, frames, 100)};
  Aim ahead{0, true, Eigen::Vector3d::UnitX(), Eigen::Matrix3Xd::Zero(3, frames),
            Eigen::Matrix3Xd::Constant(3, frames, 100)};
  up.target.row(2).setOnes();
  ahead.target.row(0).setOnes();
  for (int k = 0; k < frames; ++k) {
    const double angle = most * std::clamp((k - 0.5 * frames) / 10.0, 0.0, 1.0);
    aim.target.col(k) = Eigen::Vector3d(std::sin(angle), 0, -std::cos(angle));
  }
  problem.aims = {aim, root, up, ahead};
  return problem;
}

double Fastest(const std::vector<Posture>& postures, double rate) {
  double fastest = 0;
  for (std::size_t k = 1; k < postures.size(); ++k) {
    const Eigen::VectorXd step = postures[k].joint_angles - postures[k - 1].joint_angles;
    fastest = std::max(fastest, step.cwiseAbs().maxCoeff() * rate);
  }
  return fastest;
}

class FastSwingTest : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(FastSwingTest, VelocityLimitsHoldAndTheAimsAreReachedBesides) {
  const Robot robot = MakeBiped({});
  const auto [most, weight] = GetParam();
  TrajectoryProblem problem = SwingArm(robot, 200, most, weight);
  problem.velocity_limits.setConstant(5);
  const FitResult fit =
      FitTrajectory(problem, StartTrajectory(problem, ZeroPosture(robot.model)), {});
  EXPECT_TRUE(fit.has_converged);
  const int shoulder = robot.model.FindJoint("left_shoulder_pitch");
  EXPECT_LE(Fastest(fit.postures, problem.rate), 5);
  EXPECT_GT(Fastest(fit.postures, problem.rate), 4.95);  // the limit is used
  EXPECT_NEAR(fit.postures.back().joint_angles[shoulder], -most, 0.01);
  EXPECT_NEAR(fit.postures.front().joint_angles[shoulder], 0, 0.01);
}
INSTANTIATE_TEST_SUITE_P(OneAndTwoRadians, FastSwingTest,
                         ::testing::Values(std::pair{1.0, 20.0}, std::pair{2.0, 100.0}));

class AimlessTest : public ::testing::TestWithParam<unsigned> {};

// Places and directions at random in each frame, which nothing can follow.
TEST_P(AimlessTest, NoLimitIsBroken) {
  const Robot robot = MakeBiped({});
  TrajectoryProblem problem = SwingArm(robot, 120);
  problem.velocity_limits.setConstant(3);
  const int foot = robot.model.FindSegment("left_ankle_roll");
  problem.balls = {{foot, {0.1, 0.02, -0.08}, 0}, {foot, {-0.1, 0, -0.07}, 0.01}};
  problem.aims.push_back({foot,
                          false,
                          {0, 0, -0.08},
                          Eigen::Matrix3Xd(3, 120),
                          Eigen::Matrix3Xd::Constant(3, 120, 1000)});
  std::mt19937 random(GetParam());
  std::normal_distribution<double> normal;
  for (Aim& aim : problem.aims) {
    for (double& value : aim.target.reshaped()) value = normal(random);
    if (aim.is_direction) aim.target.colwise().normalize();
  }
  const FitResult fit =
      FitTrajectory(problem, StartTrajectory(problem, ZeroPosture(robot.model)), {3, 6});
  EXPECT_LE(Fastest(fit.postures, problem.rate), 3);
  for (const Posture& posture : fit.postures) {
    for (int j = 0; j < robot.model.num_joints(); ++j) {
      EXPECT_GE(posture.joint_angles[j], robot.model.joint(j).lower);
      EXPECT_LE(posture.joint_angles[j], robot.model.joint(j).upper);
    }
    const Eigen::Isometry3d X = SegmentPoses(robot.model, posture)[foot];
    for (const FloorBall& ball : problem.balls) {
      EXPECT_GE((X * ball.p_S).z() - ball.radius, -5.001e-4);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, AimlessTest, ::testing::Range(1U, 11U));

TEST(TrajectoryLimitsTest, AJumpIsSpreadOverTimeAndTheRestStays) {
  const Robot robot = MakeBiped({});
  TrajectoryProblem problem;
  problem.model = &robot.model;
  problem.rate = 100;
  problem.velocity_limits = Eigen::VectorXd::Constant(robot.model.num_joints(), 5);
  std::vector<Posture> postures(41, ZeroPosture(robot.model));
  const int knee = robot.model.FindJoint("left_knee");
  for (int k = 20; k <= 40; ++k) postures[k].joint_angles[knee] = 0.45;  // 9 steps of 0.05
  EXPECT_NEAR(CorrectJoints(problem, &postures), 0.2, 1e-6);
  for (int k = 0; k <= 40; ++k) {
    // The mean of ramps of 9 steps that end and that begin at the jump.
    const double ramp = 0.025 * (std::clamp(k - 11, 0, 9) + std::clamp(k - 19, 0, 9));
    EXPECT_NEAR(postures[k].joint_angles[knee], ramp, 1e-6) << k;
  }
  EXPECT_NEAR(CorrectJoints(problem, &postures), 0, 1e-6);
  postures[3].joint_angles[knee] = -0.01;  // below its limit
  EXPECT_NEAR(CorrectJoints(problem, &postures), 0.01, 1e-6);
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
  const FitResult whole = FitTrajectory(all, StartTrajectory(all, zero), {});
  const FitResult middle = FitTrajectory(part, StartTrajectory(part, zero), {});
  for (int k = 100; k < 300; ++k) {
    const Eigen::VectorXd difference =
        whole.postures[500 + k].joint_angles - middle.postures[k].joint_angles;
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 2e-3) << k;
  }
}

}  // namespace
}  // namespace mmm_converter
