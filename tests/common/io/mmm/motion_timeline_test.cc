// SPDX-License-Identifier: MIT
#include "common/io/mmm/motion_timeline.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;

std::vector<double> Times(double first, double rate, int frames, const char* format) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    times.push_back(
        std::strtod(fmt::format(fmt::runtime(format), first + k / rate).c_str(), nullptr));
  }
  return times;
}

TEST(MotionTimeline, FindsTheRateBehindRoundedTimes) {
  for (const double rate : {10.0, 30.0, 29.97, 59.94, 100.0, 119.88, 120.0, 1000.0}) {
    for (const double first : {0.0, 5.791666667}) {
      const TimeGrid grid = FitTimeGrid(Times(first, rate, 5000, "{:.9f}"));
      EXPECT_EQ(grid.rate, rate) << first;
      EXPECT_EQ(grid.num_frames(), 5000);
      EXPECT_TRUE(grid.even);
    }
    if (rate > 500) continue;  // 6 digits can't tell 1 ms from 1 ms at 1 Hz beyond 100 s
    const TimeGrid coarse = FitTimeGrid(Times(0, rate, 1000, "{:.6g}"));
    EXPECT_EQ(coarse.rate, rate);
    EXPECT_EQ(coarse.num_frames(), 1000);
  }
}

TEST(MotionTimeline, GapsJitterAndSingleTimes) {
  const TimeGrid gap = FitTimeGrid({2, 2.5, 3, 5, 5.5});
  EXPECT_EQ(gap.rate, 2);
  EXPECT_EQ(gap.first_time, 2);
  EXPECT_THAT(gap.frames, ElementsAre(0, 1, 2, 6, 7));
  EXPECT_THAT(FrameTimes(gap, {2, 2.5, 3, 5, 5.5}), ElementsAre(2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5));

  const TimeGrid jitter = FitTimeGrid({0, 0.011, 0.019, 0.031, 0.04});
  EXPECT_NEAR(jitter.rate, 100, 1e-9);  // 4 steps in 0.04 s, up to rounding
  EXPECT_TRUE(jitter.even);
  EXPECT_THAT(jitter.frames, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_FALSE(FitTimeGrid({0, 0.01, 0.02, 0.034, 0.048}).even);

  const TimeGrid single = FitTimeGrid({7});
  EXPECT_EQ(single.rate, 100);
  EXPECT_EQ(single.first_time, 7);
  EXPECT_EQ(single.num_frames(), 1);
  EXPECT_EQ(FitTimeGrid({}).num_frames(), 0);
}

TEST(MotionTimeline, ResamplesBetweenRowsAndHoldsAtTheEnds) {
  const TimedRows rows = {2, {1, 2, 4}, {0, 10, 1, 20, 5, 40}};
  const Eigen::MatrixXd values = Resample(rows, {0.8, 0.95, 1, 1.5, 2, 3, 4, 4.05, 4.2}, 0.1);
  EXPECT_TRUE(values.col(0).hasNaN());
  EXPECT_EQ(values.col(1), Eigen::Vector2d(0, 10));
  EXPECT_EQ(values.col(2), Eigen::Vector2d(0, 10));
  EXPECT_EQ(values.col(3), Eigen::Vector2d(0.5, 15));
  EXPECT_EQ(values.col(4), Eigen::Vector2d(1, 20));
  EXPECT_EQ(values.col(5), Eigen::Vector2d(3, 30));
  EXPECT_EQ(values.col(6), Eigen::Vector2d(5, 40));
  EXPECT_EQ(values.col(7), Eigen::Vector2d(5, 40));
  EXPECT_TRUE(values.col(8).hasNaN());
  EXPECT_TRUE(Resample({2, {}, {}}, {1, 2}, 0.1).hasNaN());
}

}  // namespace
}  // namespace mmm_converter
