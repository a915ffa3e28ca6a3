// SPDX-License-Identifier: MIT
#include "common/label/track/free_points.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mmm_converter {
namespace {

TEST(FreePointsTest, BeforeAnyFrameGhostsAreAsUsual) { EXPECT_EQ(FreePoints().Surplus(), 0); }

TEST(FreePointsTest, TheMeanFollowsWithinHalfASecond) {
  FreePoints free;
  free.Count(4, {0, -1, 2}, 0.25);  // two of four points are nobody's: 5 + (2 - 5) / 2
  EXPECT_DOUBLE_EQ(free.Surplus(), 2 * std::log(5 / (3.5 + 0.2)));
  free.Count(4, {0, -1, 2}, 10);  // not beyond what is seen
  EXPECT_DOUBLE_EQ(free.Surplus(), 2 * std::log(5 / 2.2));
}

TEST(FreePointsTest, TheSurplusIsBounded) {
  FreePoints none, many;
  for (int i = 0; i < 100; ++i) {
    none.Count(3, {0, 1, 2}, 0.1);
    many.Count(300, {0, 1, 2}, 0.1);
  }
  EXPECT_EQ(none.Surplus(), 6);
  EXPECT_EQ(many.Surplus(), 0);
}

}  // namespace
}  // namespace mmm_converter
