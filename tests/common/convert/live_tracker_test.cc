// SPDX-License-Identifier: MIT
#include "common/convert/live_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/units.h"
#include "tests/common/convert/fake_converter.h"

namespace mmm_converter {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using testing::FakeConverter;
using ::testing::Pointwise;
using testing::SmallSetup;

constexpr int kLabels = 6;

class LiveTrackerTest : public ::testing::Test {
 protected:
  // Whether there is a posture at this time, with so many markers seen.
  bool Track(double time, int seen) {
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(3, kLabels, kNaN);
    points.leftCols(seen).setZero();
    return tracker_.Track(points, time) != nullptr;
  }

  std::vector<double> calls_;
  LiveTracker tracker_{std::make_unique<FakeConverter>(SmallSetup(kLabels), &calls_), 100};
};

TEST_F(LiveTrackerTest, WaitsUntilEnoughMarkersAreSeen) {
  EXPECT_FALSE(Track(0, 0));
  EXPECT_FALSE(Track(0.01, 2));
  EXPECT_FALSE(tracker_.is_tracking());
  EXPECT_TRUE(Track(0.02, 3));
  EXPECT_TRUE(tracker_.is_tracking());
  EXPECT_THAT(calls_, ElementsAre(0));
}

TEST_F(LiveTrackerTest, TimesOfTheSourceDriveTheMotion) {
  for (const double time : {5.0, 5.01, 5.03, 6.5}) EXPECT_TRUE(Track(time, 6));
  const std::vector<double> steps = {0, 0.01, 0.02, 1.47};
  EXPECT_THAT(calls_, Pointwise(DoubleNear(1e-12), steps));
}

TEST_F(LiveTrackerTest, RoundedTimesAreMultiplesOfTheRate) {
  EXPECT_TRUE(Track(1000.1, 6));
  EXPECT_TRUE(Track(1000.11, 6));
  EXPECT_TRUE(Track(1000.1403, 6));
  EXPECT_EQ(calls_[1], 0.01);
  EXPECT_NEAR(calls_[2], 0.0303, 1e-9);
}

TEST_F(LiveTrackerTest, PredictsThroughUnseenFramesForTwoSeconds) {
  EXPECT_TRUE(Track(0, 6));
  EXPECT_TRUE(Track(1, 0));
  EXPECT_TRUE(Track(2, 1));
  EXPECT_FALSE(Track(2.1, 0));
  EXPECT_FALSE(Track(2.2, 0));
  EXPECT_TRUE(Track(2.3, 6));
  EXPECT_THAT(calls_, ElementsAre(0, 1, 1, 0));
  EXPECT_EQ(tracker_.starts(), 2);
}

TEST_F(LiveTrackerTest, StartsAnewAfterALongGapAndWhereTimeRunsBack) {
  EXPECT_TRUE(Track(0, 6));
  EXPECT_TRUE(Track(2.5, 6));
  EXPECT_TRUE(Track(1.0, 6));
  EXPECT_TRUE(Track(1.0, 6));
  EXPECT_THAT(calls_, ElementsAre(0, 0, 0, 0));
}

TEST_F(LiveTrackerTest, RestartsWhereAskedTo) {
  EXPECT_TRUE(Track(0, 6));
  tracker_.Restart();
  EXPECT_TRUE(Track(0.01, 6));
  EXPECT_EQ(tracker_.starts(), 2);
}

}  // namespace
}  // namespace mmm_converter
