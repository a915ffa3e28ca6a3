// SPDX-License-Identifier: MIT
#include "common/math/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
// Products of a few orthogonal matrices and trigonometric functions: some ten roundings of 1e-16.
constexpr double kRotationRounding = 1e-14;

Vector3d RandomVector(std::mt19937& generator, double scale) {
  std::normal_distribution<double> normal(0.0, scale);
  return {normal(generator), normal(generator), normal(generator)};
}

TEST(RotationTest, RpyIsYawTimesPitchTimesRoll) {
  // 90 degrees about x takes y to z; then 90 degrees about z takes x to y.
  const Matrix3d R = RotationFromRpy({kPi / 2, 0, kPi / 2});
  EXPECT_TRUE((R * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), kRotationRounding));
  EXPECT_TRUE((R * Vector3d::UnitY()).isApprox(Vector3d::UnitZ(), kRotationRounding));
}

TEST(RotationTest, TheLeastRotationBetweenDirections) {
  const Vector3d a(1, 2, -2);
  const Matrix3d R = RotationBetween(a, {0, 0, 5});
  EXPECT_TRUE((R * a / 3).isApprox(Vector3d::UnitZ(), kRotationRounding));
  EXPECT_NEAR(Eigen::AngleAxisd(R).angle(), std::acos(-2.0 / 3), 1e-12);
  EXPECT_TRUE((RotationBetween(a, -a) * a).isApprox(-a, 1e-12));
}

TEST(RotationTest, TheNearestRotationIsNoMirror) {
  std::mt19937 generator(2);
  for (int i = 0; i < 100; ++i) {
    const Matrix3d R = Exp(RandomVector(generator, 2.0)).toRotationMatrix();
    EXPECT_TRUE(NearestRotation(R * Vector3d(3, 2, 0.5).asDiagonal() * R.transpose() * R)
                    .isApprox(R, 1e-12));
    const Matrix3d mirrored = R * Vector3d(3, 2, -0.5).asDiagonal();
    EXPECT_TRUE(NearestRotation(mirrored).isApprox(R, 1e-12));
  }
}

TEST(RotationTest, RpyRoundTrip) {
  std::mt19937 generator(1);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3d R = Exp(RandomVector(generator, 2.0)).toRotationMatrix();
    EXPECT_LT((RotationFromRpy(RpyFromRotation(R)) - R).norm(), kRotationRounding * 10);
  }
}

TEST(RotationTest, RpyAtGimbalLockIsStillTheRotation) {
  for (const double pitch : {kPi / 2, -kPi / 2}) {
    const Matrix3d R = RotationFromRpy({0.3, pitch, -0.7});
    EXPECT_LT((RotationFromRpy(RpyFromRotation(R)) - R).norm(), 1e-8);
  }
}

TEST(RotationTest, ContinuousRpyFollowsThroughPiAndThroughGimbalLock) {
  Vector3d previous(3.1, 0.2, 0.0);
  const Vector3d next = ContinuousRpy(RpyFromRotation(RotationFromRpy({3.2, 0.2, 0.0})), previous);
  EXPECT_LT((next - Vector3d(3.2, 0.2, 0.0)).norm(), 1e-12);
  previous = {0.0, 1.5, 0.0};
  const Vector3d over = ContinuousRpy(RpyFromRotation(RotationFromRpy({0.0, 1.7, 0.0})), previous);
  EXPECT_LT((over - Vector3d(0.0, 1.7, 0.0)).norm(), 1e-12);
}

TEST(RotationTest, LogInvertsExpAtThreeScales) {
  std::mt19937 generator(2);
  for (const double scale : {0.0, 1e-8, 1.0}) {
    for (int i = 0; i < 200; ++i) {
      Vector3d w = RandomVector(generator, scale);
      if (w.norm() > kPi) w *= 0.9 * kPi / w.norm();
      EXPECT_LT((Log(Exp(w)) - w).norm(), 1e-13);
    }
  }
}

TEST(RotationTest, LogIsTheShortWay) {
  const Quaterniond q = Exp(Vector3d(0, 0, 1.5 * kPi));
  EXPECT_LT((Log(q) - Vector3d(0, 0, -0.5 * kPi)).norm(), 1e-14);
}

TEST(RotationTest, RightJacobianMatchesFiniteDifferences) {
  std::mt19937 generator(3);
  for (const double scale : {0.0, 1e-8, 1e-3, 1.0}) {
    const Vector3d w = RandomVector(generator, scale);
    const Matrix3d J = RightJacobian(w);
    for (int i = 0; i < 3; ++i) {
      // Central difference of a smooth function: error h^2 = 1e-10 and rounding 1e-16 / h = 1e-11.
      const double h = 1e-5;
      const Vector3d e = h * Vector3d::Unit(i);
      const Vector3d column =
          (Log(Exp(w).conjugate() * Exp(w + e)) - Log(Exp(w).conjugate() * Exp(w - e))) / (2 * h);
      EXPECT_LT((column - J.col(i)).norm(), 1e-9) << "scale " << scale;
    }
  }
}

}  // namespace
}  // namespace mmm_converter
