// SPDX-License-Identifier: MIT
#include "common/label/track/body_watch.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

constexpr double kFrame = 0.125;  // [s], exact in binary

TEST(BodyWatchTest, ABodyIsLostWhereTooFewFitForTooLong) {
  BodyWatch watch({.fitting = 0.75, .patience = 0.5});
  for (int i = 0; i < 3; ++i) watch.Count(29, 45, 40, kFrame);
  EXPECT_FALSE(watch.IsLost());
  watch.Count(29, 45, 40, kFrame);
  EXPECT_TRUE(watch.IsLost());
  watch.Count(30, 45, 40, kFrame);  // three quarters
  EXPECT_FALSE(watch.IsLost());
}

TEST(BodyWatchTest, WhatFitsIsAShareOfWhatCould) {
  const BodyWatch watch({.fitting = 0.75});
  EXPECT_TRUE(watch.Fits(30, 45, 40));
  EXPECT_FALSE(watch.Fits(29, 45, 40));
  EXPECT_TRUE(watch.Fits(18, 24, 40));
}

TEST(BodyWatchTest, WhereFewerPointsThanMarkersAreSeenTheseCount) {
  BodyWatch watch({.fitting = 0.75, .patience = kFrame});
  watch.Count(18, 24, 40, kFrame);
  EXPECT_FALSE(watch.IsLost());
  watch.Count(17, 24, 40, kFrame);
  EXPECT_TRUE(watch.IsLost());
}

TEST(BodyWatchTest, WhoIsAwayIsNotLostUnlessAbsenceCounts) {
  BodyWatch watch({.fitting = 0.75, .patience = kFrame});
  watch.Count(0, 20, 40, kFrame);
  EXPECT_FALSE(watch.IsLost());
  BodyWatch live({.fitting = 0.5, .fewest_points = 10, .counts_absence = true, .patience = kFrame});
  live.Count(5, 6, 40, kFrame);
  EXPECT_FALSE(live.IsLost());
  live.Count(4, 4, 40, kFrame);  // all of them, but too few
  EXPECT_TRUE(live.IsLost());
}

TEST(BodyWatchTest, ALookIsDueAsOftenAsThePolicySays) {
  BodyWatch watch({.every = 0.5});
  int due = 0;
  for (int i = 0; i < 16; ++i) due += watch.IsLookDue(kFrame) ? 1 : 0;
  EXPECT_EQ(due, 4);
  EXPECT_FALSE(BodyWatch({}).IsLookDue(1e9));
}

TEST(BodyWatchTest, AnotherPostureHasToBeBetterAndGiveOtherNames) {
  BodyWatch watch({.gain = 20, .other_names = 3, .running = 1});
  EXPECT_FALSE(watch.IsReplaced(100, 80, 3));
  EXPECT_TRUE(watch.IsReplaced(100, 79, 3));
  EXPECT_FALSE(watch.IsReplaced(100, 0, 2));
}

TEST(BodyWatchTest, LooksHaveToAgreeOneAfterTheOther) {
  BodyWatch watch({.gain = 20, .running = 2});
  EXPECT_FALSE(watch.IsReplaced(100, 0));
  EXPECT_FALSE(watch.IsReplaced(100, 99));
  EXPECT_FALSE(watch.IsReplaced(100, 0));
  EXPECT_TRUE(watch.IsReplaced(100, 0));
  EXPECT_FALSE(watch.IsReplaced(100, 0));  // from the beginning
}

TEST(BodyWatchTest, ARestartForgetsAll) {
  BodyWatch watch({.fitting = 0.5, .patience = kFrame, .every = 2 * kFrame, .running = 2});
  watch.Count(0, 40, 40, kFrame);
  watch.IsLookDue(kFrame);
  watch.IsReplaced(1, 0);
  watch.Restart();
  EXPECT_FALSE(watch.IsLost());
  EXPECT_FALSE(watch.IsLookDue(kFrame));
  EXPECT_FALSE(watch.IsReplaced(1, 0));
}

}  // namespace
}  // namespace mmm_converter
