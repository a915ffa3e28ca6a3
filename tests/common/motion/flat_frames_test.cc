// SPDX-License-Identifier: MIT
#include "common/motion/flat_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace mmm_converter {
namespace {

TEST(FlatFramesTest, AllMarkersAreLowAndStill) {
  MarkerSequence recording({"heel", "toe"}, 40, 100, 0);
  for (int k = 0; k < 40; ++k) {
    // The heel rises from frame 20 on, the toe from frame 30 on.
    recording.frame(k).col(0) << 0, 0, 0.05 + 0.01 * std::max(0, k - 20);
    recording.frame(k).col(1) << 0.2, 0, 0.03 + 0.01 * std::max(0, k - 30);
  }
  recording.frame(7)(2, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<int> flat = FlatFrames(recording, {0, 1});
  EXPECT_THAT(flat,
              ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19));
  EXPECT_THAT(FlatFrames(recording, {}), ::testing::IsEmpty());
}

/// A foot that stands four times for 0.3 s, 0.6 m further each time, on a ramp of this slope, every
/// second time so much higher. Its heel is 0.02 m above its toe, square to the ramp.
MarkerSequence Steps(double slope, double unevenness) {
  MarkerSequence recording({"heel", "toe"}, 200, 100, 0);
  const Eigen::Vector3d along = Eigen::Vector3d(0, 1, slope).normalized();
  const Eigen::Vector3d up = Eigen::Vector3d(0, -slope, 1).normalized();
  for (int k = 0; k < 200; ++k) {
    const int step = k / 50, in_step = k % 50;
    const double way = step + std::max(0, in_step - 30) / 20.0;
    const Eigen::Vector3d toe(0, 0.6 * way, 0.6 * way * slope + (step % 2) * unevenness);
    recording.frame(k).col(0) = toe - 0.2 * along + 0.02 * up;
    recording.frame(k).col(1) = toe;
  }
  return recording;
}

TEST(FlatFramesTest, ARampIsFoundByWhereFeetStand) {
  constexpr double kTenDegrees = 0.1763;
  const Eigen::Vector2d ramp = FindRamp(Steps(kTenDegrees, 0), {0, 1});
  EXPECT_NEAR((ramp - Eigen::Vector2d(0, kTenDegrees)).norm(), 0, 1e-9);
  EXPECT_EQ(FindRamp(Steps(0, 0), {0, 1}).norm(), 0);
  EXPECT_EQ(FindRamp(Steps(0, 0.1), {0, 1}).norm(), 0);  // now on a kerb, now beside it
  EXPECT_EQ(FindRamp(Steps(0.6, 0), {0, 1}).norm(), 0);  // stairs
  EXPECT_EQ(FindRamp(Steps(kTenDegrees, 0), {}).norm(), 0);
  // All four stances are flat on the ramp; without it the lowest alone is.
  EXPECT_GT(FlatFrames(Steps(kTenDegrees, 0), {0, 1}, ramp).back(), 150);
  EXPECT_LT(FlatFrames(Steps(kTenDegrees, 0), {0, 1}).back(), 50);
}

}  // namespace
}  // namespace mmm_converter
