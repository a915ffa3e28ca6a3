// SPDX-License-Identifier: MIT
#include "common/math/seeded_random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mmm_converter {
namespace {

constexpr int kDraws = 100000;

TEST(SeededRandomTest, EngineIsTheStandards) {
  // The C++ standard fixes the 10000th number of a default-seeded mt19937_64.
  SeededRandom random(5489);
  double last = 0;
  for (int i = 0; i < 10000; ++i) last = random.Uniform();
  EXPECT_EQ(last, static_cast<double>(9981545732273789042ULL >> 11) * 0x1p-53);
}

TEST(SeededRandomTest, NormalMoments) {
  SeededRandom random(1);
  double mean = 0;
  double square = 0;
  double fourth = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    mean += x / kDraws;
    square += x * x / kDraws;
    fourth += x * x * x * x / kDraws;
  }
  // Standard deviations 1, sqrt(2) and sqrt(96) over sqrt(1e5); three of them.
  EXPECT_NEAR(mean, 0, 0.0095);
  EXPECT_NEAR(square, 1, 0.0135);
  EXPECT_NEAR(fourth, 3, 0.093);
}

TEST(SeededRandomTest, PoissonMoments) {
  SeededRandom random(2);
  double mean = 0;
  double square = 0;
  for (int i = 0; i < kDraws; ++i) {
    const int n = random.Poisson(100);
    mean += n / static_cast<double>(kDraws);
    square += (n - 100.0) * (n - 100.0) / kDraws;
  }
  // Standard deviations 10 and about 100 sqrt(2) over sqrt(1e5); three of them.
  EXPECT_NEAR(mean, 100, 0.095);
  EXPECT_NEAR(square, 100, 1.4);
  EXPECT_EQ(random.Poisson(0), 0);
}

TEST(SeededRandomTest, IndexCoversItsRange) {
  SeededRandom random(3);
  int counts[5] = {};
  for (int i = 0; i < 1000; ++i) ++counts[random.UniformIndex(5)];
  for (const int count : counts) EXPECT_NEAR(count, 200, 38);  // three times sqrt(1000 * 0.16)
}

TEST(SeededRandomTest, IndexAtShareIsWhereTheSumReachesIt) {
  const Eigen::Vector4d weights(1, 0, 2, 1);
  EXPECT_EQ(IndexAtShare(0, weights), 0);
  EXPECT_EQ(IndexAtShare(0.25, weights), 0);
  EXPECT_EQ(IndexAtShare(0.26, weights), 2);
  EXPECT_EQ(IndexAtShare(0.75, weights), 2);
  EXPECT_EQ(IndexAtShare(0.76, weights), 3);
  EXPECT_EQ(IndexAtShare(std::nextafter(1.0, 0.0), weights), 3);
  // Without any weight, and with none but one.
  EXPECT_EQ(IndexAtShare(0.5, Eigen::Vector3d::Zero()), 0);
  EXPECT_EQ(IndexAtShare(0.5, Eigen::VectorXd::Ones(1)), 0);
}

}  // namespace
}  // namespace mmm_converter
