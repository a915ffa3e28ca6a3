// SPDX-License-Identifier: MIT
#include "common/label/search/rigid_finder.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/math/seeded_random.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Matrix3Xd Shape(int markers, SeededRandom* random) {
  Matrix3Xd p_OM(3, markers);
  for (double& x : p_OM.reshaped()) x = 0.4 * random->Uniform();
  return p_OM;
}

/// The shape somewhere, then points within 2 m of the origin.
Matrix3Xd AmongOthers(const Matrix3Xd& p_OM, int others, SeededRandom* random) {
  Matrix3Xd points(3, p_OM.cols() + others);
  for (double& x : points.reshaped()) x = 4 * random->Uniform() - 2;
  const Eigen::Matrix3d R(Eigen::AngleAxisd(3 * random->Uniform(), Vector3d(2, 1, 2) / 3));
  points.leftCols(p_OM.cols()) = (R * p_OM).colwise() + Vector3d(0.5, 0.3, 1);
  return points;
}

TEST(RigidFinder, FindsAnObjectAmongManyPoints) {
  for (int seed = 1; seed <= 10; ++seed) {
    SeededRandom random(seed);
    const int markers = 3 + seed % 4;
    const Matrix3Xd p_OM = Shape(markers, &random);
    const Matrix3Xd points = AmongOthers(p_OM, 80, &random);
    std::vector<int> expected(static_cast<std::size_t>(markers));
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(RigidFinder(p_OM).Find(points), expected) << "seed " << seed;
  }
}

TEST(RigidFinder, FourMarkersAreEnoughAndThreeOfMoreAreNot) {
  SeededRandom random(20);
  const Matrix3Xd p_OM = Shape(6, &random);
  const Matrix3Xd points = AmongOthers(p_OM, 40, &random);
  RigidFinder finder(p_OM);
  EXPECT_EQ(finder.Find(points.rightCols(points.cols() - 2)),
            (std::vector<int>{-1, -1, 0, 1, 2, 3}));
  EXPECT_EQ(finder.Find(points.rightCols(points.cols() - 3)), std::vector<int>(6, -1));
}

TEST(RigidFinder, AMirroredObjectIsAnother) {
  Matrix3Xd p_OM(3, 4);
  p_OM << 0, 0.3, 0, 0.1, 0, 0, 0.4, 0.1, 0, 0, 0, 0.25;
  Matrix3Xd mirrored = p_OM;
  mirrored.row(0) *= -1;
  EXPECT_EQ(RigidFinder(p_OM).Find(p_OM), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(RigidFinder(p_OM).Find(mirrored), std::vector<int>(4, -1));
}

TEST(RigidFinder, MarkersAsCloseAsItMovesInAFrameStayApart) {
  constexpr double kStep = 0.03;  // [m]
  constexpr int kFrames = 40;
  int found = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    SeededRandom random(seed);
    Matrix3Xd p_OM = Shape(5, &random);
    p_OM.col(4) = p_OM.col(0) + Vector3d(kStep, 0, 0);
    RigidFinder finder(p_OM);
    bool is_there = false;
    for (int k = 0; k < kFrames; ++k) {
      const Eigen::Matrix3d R(Eigen::AngleAxisd(0.02 * k, Vector3d(1, 2, 2) / 3));
      const Matrix3Xd now =
          (R * p_OM).colwise() + R * Vector3d(seed % 2 == 0 ? kStep * k : -kStep * k, 0, 0);
      std::vector<int> points;
      if (is_there) points = finder.Follow(now);
      if (!is_there || points[0] + points[1] + points[2] < 0) points = finder.Find(now);
      is_there = false;
      for (int m = 0; m < 5; ++m) {
        if (points[static_cast<std::size_t>(m)] < 0) continue;
        is_there = true;
        ++found;
        EXPECT_EQ(points[static_cast<std::size_t>(m)], m) << "seed " << seed << ", frame " << k;
      }
    }
  }
  EXPECT_GE(found, 0.99 * 20 * kFrames * 5);
}

TEST(RigidFinder, FollowsThreeThatAreInTheirPlaces) {
  SeededRandom random(22);
  const Matrix3Xd p_OM = Shape(6, &random);
  const Matrix3Xd points = AmongOthers(p_OM, 30, &random);
  const auto moved = [&points](int k) {
    const Eigen::Matrix3d R(Eigen::AngleAxisd(0.03 * k, Vector3d::UnitZ()));
    return Matrix3Xd((R * points).colwise() + Vector3d(0.03 * k, 0, 0));
  };
  RigidFinder finder(p_OM);
  EXPECT_EQ(finder.Follow(points), std::vector<int>(6, -1));
  EXPECT_EQ(finder.Find(points)[5], 5);
  for (int k = 1; k < 50; ++k) {
    Matrix3Xd now = moved(k);
    now.col(k % 6).x() += 0.04;  // this one slips
    std::vector<int> expected = {0, 1, 2, 3, 4, 5};
    expected[static_cast<std::size_t>(k % 6)] = -1;
    if (k < 25) {
      EXPECT_EQ(finder.Follow(now), expected) << k;
      continue;
    }
    EXPECT_EQ(finder.Follow(moved(k).rightCols(now.cols() - 3)),
              (std::vector<int>{-1, -1, -1, 0, 1, 2}))
        << k;
  }
  EXPECT_EQ(finder.Follow(moved(49).rightCols(points.cols() - 4)), std::vector<int>(6, -1));
  EXPECT_EQ(finder.Follow(moved(49)), std::vector<int>(6, -1));  // has to be found anew
}

TEST(RigidFinder, WithoutPointsThereIsNothing) {
  SeededRandom random(23);
  const Matrix3Xd p_OM = Shape(4, &random);
  RigidFinder finder(p_OM);
  EXPECT_EQ(finder.Find(Matrix3Xd(3, 0)), std::vector<int>(4, -1));
  EXPECT_EQ(finder.Follow(Matrix3Xd(3, 0)), std::vector<int>(4, -1));
}

}  // namespace
}  // namespace mmm_converter
