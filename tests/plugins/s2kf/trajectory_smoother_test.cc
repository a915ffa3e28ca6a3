// SPDX-License-Identifier: MIT
#include "plugins/s2kf/trajectory_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>
#include <vector>

#include "common/math/rotation.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSmoothedJoints = 3;
constexpr int kSmoothedStates = 6 + kSmoothedJoints;
constexpr int kSmoothedFrames = 12;
constexpr double kStep = 0.02;

MotionModel SomeModel(bool velocity, double natural_spread) {
  MotionModel model;
  model.noise = velocity ? ProcessNoise{1, 2, 3} : ProcessNoise{0.3, 0.2, 0.1};
  model.natural = VectorXd::LinSpaced(kSmoothedJoints, 0.1, 0.2);
  model.natural_spread = natural_spread;
  model.velocity = velocity;
  return model;
}

JointLimitTransform SomeLimits(LimitFunction function) {
  return {function, VectorXd::Constant(kSmoothedJoints, -1),
          VectorXd::Constant(kSmoothedJoints, 2)};
}

/// z = H x + noise of some coordinates, linear: the orientation is measured about 0, in its error
/// state, so that it stays there.
struct Measurement {
  MatrixXd H;
  VectorXd z;
  VectorXd R;
};

VectorXd Vector(const Belief& belief) {
  VectorXd x(belief.P.rows());
  x << belief.position, Eigen::Vector3d::Zero(), belief.parameters, belief.rate;
  return x;
}

/// A filter's run over a linear problem: each frame's belief, and what it was given.
struct LinearRun {
  LinearRun(const MotionModel& model, const JointLimitTransform& limits, std::uint32_t seed)
      : all(model.velocity ? 2 * kSmoothedStates : kSmoothedStates) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto draw = [&](int rows, int cols) {
      MatrixXd M(rows, cols);
      for (double& value : M.reshaped()) value = normal(random);
      return M;
    };
    Belief belief;
    belief.position = {1, 2, 3};
    belief.parameters = VectorXd::LinSpaced(kSmoothedJoints, -0.4, 0.8);
    if (model.velocity) {
      belief.rate = draw(kSmoothedStates, 1);
      belief.rate.segment<3>(3).setZero();
    }
    const MatrixXd A = draw(all, all);
    belief.P = A * A.transpose() / all + 0.1 * MatrixXd::Identity(all, all);
    // The orientation is independent of the rest.
    for (int i = 0; i < all; ++i) {
      if (i % kSmoothedStates < 3 || i % kSmoothedStates >= 6) continue;
      for (int j = 0; j < all; ++j) {
        if (j % kSmoothedStates < 3 || j % kSmoothedStates >= 6)
          belief.P(i, j) = belief.P(j, i) = 0;
      }
    }
    start = belief;
    for (int k = 0; k < kSmoothedFrames; ++k) {
      if (k > 0) {
        Fold(limits, &belief);
        model.Predict(kStep, RootParameters::kSo3, &belief);
      }
      Measurement m;
      m.H = MatrixXd::Zero(5, all);
      m.H.leftCols(3) = draw(5, 3);
      m.H.middleCols(6, kSmoothedJoints) = draw(5, kSmoothedJoints);
      m.z = m.H * Vector(belief) + 0.3 * draw(5, 1);
      m.R = VectorXd::Constant(5, 0.01);
      const MatrixXd S = m.H * belief.P * m.H.transpose() + m.R.asDiagonal().toDenseMatrix();
      const MatrixXd K = belief.P * m.H.transpose() * S.inverse();
      const VectorXd dx = K * (m.z - m.H * Vector(belief));
      Move(dx.head(kSmoothedStates), RootParameters::kSo3, &belief);
      if (model.velocity) belief.rate += dx.tail(kSmoothedStates);
      belief.P -= K * S * K.transpose();
      filtered.push_back(belief);
      measurements.push_back(m);
    }
  }

  int all;
  Belief start;
  std::vector<Belief> filtered;
  std::vector<Measurement> measurements;
};

/// x+ = F x + c + B w with w ~ N(0, I), taken from Predict.
struct LinearModel {
  LinearModel(const MotionModel& model, int all) : F(all, all) {
    Belief zero;
    zero.parameters.setZero(kSmoothedJoints);
    if (model.velocity) zero.rate.setZero(kSmoothedStates);
    zero.P.setZero(all, all);
    Belief moved = zero;
    model.Predict(kStep, RootParameters::kSo3, &moved);
    Difference(zero, moved, RootParameters::kSo3, &c);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(moved.P);
    B = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
    for (int i = 0; i < all; ++i) {
      Belief unit = zero;
      Move(MatrixXd::Identity(all, all).col(i).head(kSmoothedStates), RootParameters::kSo3, &unit);
      if (i >= kSmoothedStates) unit.rate[i - kSmoothedStates] = 1;
      model.Predict(kStep, RootParameters::kSo3, &unit);
      VectorXd column;
      Difference(zero, unit, RootParameters::kSo3, &column);
      F.col(i) = column - c;
    }
  }

  MatrixXd F;
  MatrixXd B;
  VectorXd c;
};

struct Batch {
  std::vector<VectorXd> means;
  std::vector<MatrixXd> covariances;
};

/// All frames at once, by the normal equations for the first state and the noise of every step.
Batch SolveBatch(const LinearRun& run, const MotionModel& model) {
  const LinearModel linear(model, run.all);
  const int n = run.all;
  const int unknowns = n * kSmoothedFrames;
  MatrixXd information = MatrixXd::Identity(unknowns, unknowns);
  VectorXd right = VectorXd::Zero(unknowns);
  const MatrixXd P_inverse = run.start.P.inverse();
  information.topLeftCorner(n, n) = P_inverse;
  right.head(n) = P_inverse * Vector(run.start);
  std::vector<MatrixXd> maps;  // x_k = maps[k] unknowns + constants[k]
  std::vector<VectorXd> constants;
  for (int k = 0; k < kSmoothedFrames; ++k) {
    MatrixXd map = MatrixXd::Zero(n, unknowns);
    VectorXd constant = VectorXd::Zero(n);
    if (k == 0) {
      map.leftCols(n).setIdentity();
    } else {
      map = linear.F * maps.back();
      map.middleCols(k * n, n) = linear.B;
      constant = linear.F * constants.back() + linear.c;
    }
    const Measurement& m = run.measurements[k];
    const MatrixXd H = m.H * map;
    information += H.transpose() * m.R.cwiseInverse().asDiagonal() * H;
    right += H.transpose() * m.R.cwiseInverse().asDiagonal() * (m.z - m.H * constant);
    maps.push_back(map);
    constants.push_back(constant);
  }
  const Eigen::LDLT<MatrixXd> solver(information);
  Batch batch;
  for (int k = 0; k < kSmoothedFrames; ++k) {
    batch.means.emplace_back(maps[k] * solver.solve(right) + constants[k]);
    batch.covariances.emplace_back(maps[k] * solver.solve(maps[k].transpose()));
  }
  return batch;
}

struct SmootherCase {
  bool velocity;
  double natural_spread;
};

class TrajectorySmootherTest : public ::testing::TestWithParam<SmootherCase> {};

TEST_P(TrajectorySmootherTest, IsTheBatchSolution) {
  const MotionModel model = SomeModel(GetParam().velocity, GetParam().natural_spread);
  const JointLimitTransform limits = SomeLimits(LimitFunction::kTanh);
  const LinearRun run(model, limits, 1);
  const Batch batch = SolveBatch(run, model);
  TrajectorySmoother smoother(model, limits, RootParameters::kSo3, kSmoothedStates);
  smoother.Start(run.filtered.back());
  for (int k = kSmoothedFrames - 1; k >= 0; --k) {
    if (k < kSmoothedFrames - 1) smoother.StepBack(run.filtered[k], kStep);
    const Belief& smoothed = smoother.belief();
    EXPECT_LT((Vector(smoothed) - batch.means[k]).norm(), 1e-9) << "frame " << k;
    EXPECT_LT((smoothed.P - batch.covariances[k]).norm(), 1e-9) << "frame " << k;
    EXPECT_TRUE(
        (smoothed.P.diagonal().array() <= run.filtered[k].P.diagonal().array() * (1 + 1e-12))
            .all());
  }
}

TEST(SmoothedEstimateTest, ParametersMoveARadianAtMost) {
  Belief filtered;
  filtered.parameters = VectorXd::Zero(kSmoothedJoints);
  filtered.parameters[0] = std::numbers::pi / 2;
  Belief smoothed = filtered;
  smoothed.parameters[0] -= 3;  // beside a limit no marker says how far
  smoothed.parameters[1] = 0.01;
  TrajectorySmoother smoother(SomeModel(false, 0), SomeLimits(LimitFunction::kSine),
                              RootParameters::kSo3, kSmoothedStates);
  smoother.Start(smoothed);
  Belief estimate;
  smoother.EstimateAbout(filtered, &estimate);
  EXPECT_NEAR(estimate.parameters[0], std::numbers::pi / 2 - std::tanh(3), 1e-9);
  EXPECT_NEAR(estimate.parameters[1], 0.01, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Models, TrajectorySmootherTest,
                         ::testing::Values(SmootherCase{false, 0}, SmootherCase{false, 0.15},
                                           SmootherCase{true, 0}, SmootherCase{true, 0.5}));

}  // namespace
}  // namespace mmm_converter::s2kf
