// SPDX-License-Identifier: MIT
#include "plugins/s2kf/joint_limit_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace mmm_converter::s2kf {
namespace {

constexpr double kPi = std::numbers::pi;

JointLimitTransform MakeTransform(LimitFunction function) {
  return {function, Eigen::Vector2d(-0.5, 0), Eigen::Vector2d(1.5, 2.8)};
}

class JointLimitTransformTest : public ::testing::TestWithParam<LimitFunction> {};

TEST_P(JointLimitTransformTest, EveryParameterIsInsideTheLimits) {
  const JointLimitTransform transform = MakeTransform(GetParam());
  for (int i = -5000; i < 5000; ++i) {
    const double parameter = 0.01 * i;
    EXPECT_GE(transform.Angle(0, parameter), -0.5);
    EXPECT_LE(transform.Angle(0, parameter), 1.5);
  }
}

TEST_P(JointLimitTransformTest, ParameterInvertsAngleAwayFromTheLimits) {
  const JointLimitTransform transform = MakeTransform(GetParam());
  for (int i = 5; i < 270; ++i) {
    const double angle = 0.01 * i;
    EXPECT_NEAR(transform.Angle(1, transform.Parameter(1, angle)), angle, 1e-13);
  }
  EXPECT_GT(transform.Slope(1, transform.Parameter(1, 2.8)), 0.04 * 1.4);
  EXPECT_GT(transform.Slope(1, transform.Parameter(1, -7)), 0.04 * 1.4);
}

TEST_P(JointLimitTransformTest, SlopeMatchesFiniteDifferences) {
  const JointLimitTransform transform = MakeTransform(GetParam());
  for (const double parameter : {0.0, 1e-8, 0.7, -1.3}) {
    const double h = 1e-5;  // error h^2 / 6 and 1e-16 / h
    const double slope =
        (transform.Angle(0, parameter + h) - transform.Angle(0, parameter - h)) / (2 * h);
    EXPECT_NEAR(transform.Slope(0, parameter), slope, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, JointLimitTransformTest,
                         ::testing::Values(LimitFunction::kSine, LimitFunction::kTanh));

TEST(JointLimitTransformFoldTest, KeepsTheAngleAndTellsWhereItsSlopeTurns) {
  const JointLimitTransform transform = MakeTransform(LimitFunction::kSine);
  for (const double parameter : {0.3, 1.9, -2.5, 4.0, 7.1, -11.0}) {
    double folded = parameter;
    const double sign = transform.Fold(0, &folded) ? -1 : 1;
    EXPECT_LE(std::abs(folded), kPi / 2);
    EXPECT_NEAR(transform.Angle(0, folded), transform.Angle(0, parameter), 1e-13);
    EXPECT_NEAR(transform.Slope(0, folded), sign * transform.Slope(0, parameter), 1e-13);
  }
}

TEST(JointLimitTransformDeviationTest, IsThatOfManyDraws) {
  const JointLimitTransform transform = MakeTransform(LimitFunction::kSine);
  std::mt19937_64 random(1);
  for (const double mean : {0.0, 0.8, kPi / 2}) {
    for (const double deviation : {0.05, 0.6, 3.0}) {
      std::normal_distribution<double> normal(mean, deviation);
      double sum = 0;
      double squares = 0;
      constexpr int kDraws = 200000;
      for (int i = 0; i < kDraws; ++i) {
        const double angle = transform.Angle(0, normal(random));
        sum += angle;
        squares += angle * angle;
      }
      const double drawn = std::sqrt(squares / kDraws - sum / kDraws * sum / kDraws);
      // Four standard errors of a standard deviation from 200,000 draws: 4 / sqrt(2 * 2e5).
      EXPECT_NEAR(transform.AngleDeviation(0, mean, deviation) / drawn, 1, 0.01);
    }
  }
}

}  // namespace
}  // namespace mmm_converter::s2kf
