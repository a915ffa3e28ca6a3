// SPDX-License-Identifier: MIT
#include "plugins/s2kf/motion_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kJoints = 4;
constexpr int kStates = 6 + kJoints;
// Products of matrices of size below 20 with entries of about 1.
constexpr double kMotionRounding = 1e-13;

Belief SomeBelief(bool velocity) {
  std::srand(3);
  Belief belief;
  belief.position = {1, 2, 3};
  belief.orientation = Exp({0.1, -0.2, 0.3});
  belief.parameters = VectorXd::LinSpaced(kJoints, -0.4, 0.8);
  const int all = velocity ? 2 * kStates : kStates;
  if (velocity) belief.rate = VectorXd::LinSpaced(kStates, -1, 1);
  const MatrixXd A = MatrixXd::Random(all, all);
  belief.P = A * A.transpose();
  return belief;
}

MotionModel SomeModel() {
  MotionModel model;
  model.noise = {0.3, 0.2, 0.1};
  model.natural = VectorXd::LinSpaced(kJoints, 0.1, 0.2);
  return model;
}

VectorXd NoiseOf(const ProcessNoise& noise) {
  VectorXd q(kStates);
  q << Eigen::Vector3d::Constant(noise.position * noise.position),
      Eigen::Vector3d::Constant(noise.orientation * noise.orientation),
      VectorXd::Constant(kJoints, noise.parameters * noise.parameters);
  return q;
}

TEST(MotionModelTest, RandomWalkStaysAndSpreadsWithTime) {
  Belief belief = SomeBelief(false);
  const Belief before = belief;
  SomeModel().Predict(0.02, RootParameters::kSo3, &belief);
  EXPECT_EQ(belief.position, before.position);
  EXPECT_EQ(belief.parameters, before.parameters);
  const MatrixXd Q = 0.02 * NoiseOf(SomeModel().noise).asDiagonal().toDenseMatrix();
  EXPECT_LT((belief.P - before.P - Q).norm(), kMotionRounding);
}

TEST(MotionModelTest, TwoHalfStepsAreOneStep) {
  Belief halves = SomeBelief(false);
  Belief whole = halves;
  for (int i = 0; i < 2; ++i) SomeModel().Predict(0.01, RootParameters::kSo3, &halves);
  SomeModel().Predict(0.02, RootParameters::kSo3, &whole);
  EXPECT_LT((halves.P - whole.P).norm(), kMotionRounding);
}

TEST(MotionModelTest, ThePapersNoiseIsThatOfA10MsFrame) {
  MotionModel paper;
  paper.noise = {0.050, 1e-4, 1e-4};
  Belief belief = SomeBelief(false);
  belief.P.setZero();
  paper.Predict(0.01, RootParameters::kRpy, &belief);
  EXPECT_NEAR(belief.P(0, 0), 25e-6, 1e-18);  // 25 mm^2
  EXPECT_NEAR(belief.P(3, 3), 1e-10, 1e-22);  // rad^2
  EXPECT_NEAR(belief.P(9, 9), 1e-10, 1e-22);
}

TEST(MotionModelTest, ReversionEndsAtTheNaturalPostureWithItsSpread) {
  MotionModel model = SomeModel();
  model.natural_spread = 0.15;
  Belief belief = SomeBelief(false);
  // tau = 2 * 0.15^2 / 0.1^2 = 4.5 s; 200 s are 44 of them. The noise of a step is added whole,
  // which at 0.01 s makes the variance larger by dt / tau.
  for (int i = 0; i < 20000; ++i) model.Predict(0.01, RootParameters::kSo3, &belief);
  EXPECT_LT((belief.parameters - model.natural).norm(), 1e-12);
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_NEAR(std::sqrt(belief.P(6 + j, 6 + j)), 0.15, 0.15 * 0.01 / 4.5);
  }
  EXPECT_EQ(belief.P, belief.P.transpose());
}

MotionModel VelocityModel() {
  MotionModel model = SomeModel();
  model.velocity = true;
  model.noise = {1, 2, 3};
  return model;
}

TEST(MotionModelTest, VelocityIsTheLinearModelWithDamping) {
  const MotionModel model = VelocityModel();
  Belief belief = SomeBelief(true);
  const Belief before = belief;
  const double dt = 0.05;
  model.Predict(dt, RootParameters::kSo3, &belief);

  const double a = std::exp(-dt / 0.2);
  const double T = 0.2 * (1 - a);
  MatrixXd F = MatrixXd::Identity(2 * kStates, 2 * kStates);
  F.topRightCorner(kStates, kStates).diagonal().setConstant(T);
  F.bottomRightCorner(kStates, kStates).diagonal().setConstant(a);
  // What an acceleration of variance noise^2 / dt, constant for dt, does to state and rate.
  MatrixXd G(2 * kStates, kStates);
  G << MatrixXd::Identity(kStates, kStates) * 0.2 * (dt - T),
      MatrixXd::Identity(kStates, kStates) * T;
  const MatrixXd Q = G * (NoiseOf(model.noise) / dt).asDiagonal() * G.transpose();
  const MatrixXd P = F * before.P * F.transpose() + Q;
  EXPECT_LT((belief.P - P).norm(), kMotionRounding);
  // Columns are moved before rows: a term may be rounded otherwise than its mirror image.
  EXPECT_LT((belief.P - belief.P.transpose()).norm(), kMotionRounding);
  EXPECT_LT((belief.rate - a * before.rate).norm(), kMotionRounding);
  EXPECT_LT((belief.position - before.position - T * before.rate.head<3>()).norm(),
            kMotionRounding);
  EXPECT_LT((belief.parameters - before.parameters - T * before.rate.tail(kJoints)).norm(),
            kMotionRounding);
  const Eigen::Vector3d turned = Log(before.orientation.conjugate() * belief.orientation);
  EXPECT_LT((turned - T * before.rate.segment<3>(3)).norm(), kMotionRounding);
}

TEST(MotionModelTest, TheSpringEndsAtTheNaturalPostureWithItsSpread) {
  MotionModel model = VelocityModel();
  model.natural_spread = 0.5;
  Belief belief = SomeBelief(true);
  const double omega = std::cbrt(9 / (4 * 0.25));
  // 40 s are 83 time constants. The noise is constant within a step: its spectrum falls where
  // (omega dt / 2)^2 counts.
  for (int i = 0; i < 4000; ++i) model.Predict(0.01, RootParameters::kSo3, &belief);
  EXPECT_LT((belief.parameters - model.natural).norm(), 1e-12);
  EXPECT_LT(belief.rate.tail(kJoints).norm(), 1e-12);
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_NEAR(std::sqrt(belief.P(6 + j, 6 + j)), 0.5, 0.5 * std::pow(0.005 * omega, 2));
  }
}

TEST(MotionModelTest, TheSpringSwingsAsItsClosedForm) {
  MotionModel model = VelocityModel();
  model.natural_spread = 0.5;
  Belief whole = SomeBelief(true);
  Belief halves = whole;
  model.Predict(0.2, RootParameters::kSo3, &whole);
  for (int i = 0; i < 2; ++i) model.Predict(0.1, RootParameters::kSo3, &halves);
  EXPECT_LT((whole.parameters - halves.parameters).norm(), kMotionRounding);
  EXPECT_LT((whole.rate.tail(kJoints) - halves.rate.tail(kJoints)).norm(), kMotionRounding);
  // x'' = -2 omega x' - omega^2 x, by a step so short that h^2 counts.
  const double omega = std::cbrt(9 / (4 * 0.25));
  const Belief start = SomeBelief(true);
  Belief moved = start;
  const double h = 1e-6;
  model.Predict(h, RootParameters::kSo3, &moved);
  const VectorXd x = start.parameters - model.natural;
  const VectorXd v = start.rate.tail(kJoints);
  EXPECT_LT(((moved.parameters - start.parameters) / h - v).norm(), 1e-4);
  EXPECT_LT(((moved.rate.tail(kJoints) - v) / h + 2 * omega * v + omega * omega * x).norm(), 1e-4);
}

TEST(BeliefTest, DifferenceUndoesMove) {
  const Belief a = SomeBelief(true);
  Belief b = a;
  VectorXd dx = VectorXd::LinSpaced(2 * kStates, -0.5, 1.0);
  Move(dx.head(kStates), RootParameters::kSo3, &b);
  b.rate += dx.tail(kStates);
  VectorXd difference;
  Difference(a, b, RootParameters::kSo3, &difference);
  EXPECT_LT((difference - dx).norm(), kMotionRounding);
}

TEST(BeliefTest, FoldingTurnsTheSignsOfRateAndCovariance) {
  const JointLimitTransform limits(LimitFunction::kSine, VectorXd::Constant(kJoints, -1),
                                   VectorXd::Constant(kJoints, 2));
  Belief belief = SomeBelief(true);
  belief.parameters[1] = 1.9;
  const Belief before = belief;
  Fold(limits, &belief);
  EXPECT_LE(belief.parameters.cwiseAbs().maxCoeff(), 1.5708);
  // Cov(theta_1, r) and d theta_1 / dt are the same before and after.
  const double slope = limits.Slope(1, before.parameters[1]);
  const double folded = limits.Slope(1, belief.parameters[1]);
  EXPECT_NEAR(folded * belief.P(7, 0), slope * before.P(7, 0), kMotionRounding);
  EXPECT_NEAR(folded * belief.P(kStates + 7, 0), slope * before.P(kStates + 7, 0), kMotionRounding);
  EXPECT_NEAR(folded * belief.rate[7], slope * before.rate[7], kMotionRounding);
  EXPECT_EQ(belief.P(7, kStates + 7), before.P(7, kStates + 7));
  EXPECT_EQ(belief.P, belief.P.transpose());
}

TEST(BeliefTest, MoveTurnsInTheBodyOrAddsToRollPitchYaw) {
  Belief so3 = SomeBelief(false);
  Belief rpy = so3;
  rpy.rpy = {0.3, 0.2, 0.1};
  VectorXd dx = VectorXd::LinSpaced(kStates, 0.1, 1.0);
  Move(dx, RootParameters::kSo3, &so3);
  Move(dx, RootParameters::kRpy, &rpy);
  const Belief before = SomeBelief(false);
  EXPECT_LT((so3.position - before.position - dx.head<3>()).norm(), kMotionRounding);
  EXPECT_LT(so3.orientation.angularDistance(before.orientation * Exp(dx.segment<3>(3))), 1e-7);
  EXPECT_LT((rpy.rpy - Eigen::Vector3d(0.3, 0.2, 0.1) - dx.segment<3>(3)).norm(), kMotionRounding);
  EXPECT_LT((rpy.orientation.toRotationMatrix() - RotationFromRpy(rpy.rpy)).norm(),
            kMotionRounding);
  EXPECT_LT((so3.parameters - before.parameters - dx.tail(kJoints)).norm(), kMotionRounding);
}

}  // namespace
}  // namespace mmm_converter::s2kf
