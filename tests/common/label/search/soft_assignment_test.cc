// SPDX-License-Identifier: MIT
#include "common/label/search/soft_assignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/seeded_random.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

Matrix3Xd RandomPoints(int count, std::uint64_t seed) {
  SeededRandom random(seed);
  Matrix3Xd points(3, count);
  for (double& x : points.reshaped()) x = random.Uniform();
  return points;
}

TEST(SoftAssignmentTest, AMarkerWithOnePointInItsPlaceHasNearlyAllOfIt) {
  SoftAssignment soft;
  soft.Compute(Matrix3Xd::Zero(3, 1), VectorXd::Constant(1, 0.01), Matrix3Xd::Zero(3, 1));
  EXPECT_GT(soft.weights()[0], 0.97);
  EXPECT_LT(soft.weights()[0], 1);
  EXPECT_EQ(soft.targets().col(0).norm(), 0);
}

TEST(SoftAssignmentTest, TwoPointsAsNearShareAMarker) {
  SoftAssignment soft;
  Matrix3Xd points(3, 2);
  points << 0.1, -0.1, 0.3, 0.3, 0, 0;
  soft.Compute(Matrix3Xd::Zero(3, 1), VectorXd::Constant(1, 0.04), points);
  EXPECT_NEAR(soft.targets()(0, 0), 0, 1e-15);
  EXPECT_NEAR(soft.targets()(1, 0), 0.3, 1e-15);
}

TEST(SoftAssignmentTest, NoPointIsGivenMoreThanOnce) {
  const Matrix3Xd places = RandomPoints(8, 1);
  const Matrix3Xd points = RandomPoints(5, 2);
  SoftAssignment soft;
  soft.Compute(places, VectorXd::Constant(8, 0.05), points);
  EXPECT_LE(soft.weights().sum(), 5);
  EXPECT_LE(soft.weights().maxCoeff(), 1.05);  // balanced but for the last round
  EXPECT_GE(soft.weights().minCoeff(), 0);
  for (int m = 0; m < 8; ++m) {
    EXPECT_TRUE(
        (soft.targets().col(m).array() >= points.rowwise().minCoeff().array() - 1e-12).all());
    EXPECT_TRUE(
        (soft.targets().col(m).array() <= points.rowwise().maxCoeff().array() + 1e-12).all());
  }
}

TEST(SoftAssignmentTest, WhatIsFarFromAllPointsHasNoTarget) {
  SoftAssignment soft;
  Matrix3Xd places = Matrix3Xd::Zero(3, 2);
  places(0, 1) = 10;
  soft.Compute(places, VectorXd::Constant(2, 0.01), Matrix3Xd::Zero(3, 1));
  EXPECT_TRUE(soft.targets().col(0).allFinite());
  EXPECT_TRUE(std::isnan(soft.targets()(0, 1)));
  EXPECT_EQ(soft.weights()[1], 0);
}

TEST(SoftAssignmentTest, TheSmallerTheVarianceTheMoreEachHasItsOwnPoint) {
  SoftAssignment soft;
  Matrix3Xd places(3, 2), points(3, 2);
  places << 0, 0.1, 0, 0, 0, 0;
  points << 0.02, 0.12, 0, 0, 0, 0;
  double last = 1;
  for (const double spread : {0.2, 0.1, 0.05, 0.03}) {
    soft.Compute(places, VectorXd::Constant(2, spread * spread), points);
    const double off = (soft.targets() - points).colwise().norm().maxCoeff();
    EXPECT_LT(off, last);
    last = off;
  }
  EXPECT_LT(last, 0.005);
}

}  // namespace
}  // namespace mmm_converter
