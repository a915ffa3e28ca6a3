// SPDX-License-Identifier: MIT
#include "common/live/stream_clock.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

constexpr double kRate = 100;

SteadyTime At(double seconds) {
  return SteadyTime() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                            std::chrono::duration<double>(10 + seconds));
}

TEST(StreamClock, IsTheSourcesAsLongAsThatGoesOn) {
  StreamClock clock;
  EXPECT_EQ(clock.Take(57, At(0), kRate, true), 57);
  EXPECT_EQ(clock.Take(57.01, At(0.3), kRate, false), 57.01);
  EXPECT_EQ(clock.Take(57.03, At(0.31), kRate, false), 57.03);  // one was lost
  EXPECT_EQ(clock.Take(57.02, At(0.31), kRate, false), 57.02);  // it came late
  EXPECT_EQ(clock.Take(61.02, At(4.3), kRate, true), 61.02);    // connected again
  EXPECT_EQ(clock.outage(), 0);
}

TEST(StreamClock, KeepsAnOutageThatTheSourcesClockDoesNot) {
  for (const double anew :
       {0.0, 12.0, 900.0}) {  // frames are counted from 0, or by another's clock
    StreamClock clock;
    EXPECT_EQ(clock.Take(20, At(0), kRate, true), 20);
    EXPECT_NEAR(clock.Take(anew, At(4), kRate, true), 24, 1e-9);
    EXPECT_NEAR(clock.outage(), 4, 1e-9);
    EXPECT_NEAR(clock.Take(anew + 0.01, At(4.01), kRate, false), 24.01, 1e-9);
    EXPECT_EQ(clock.outage(), 0);
    EXPECT_NEAR(clock.Take(anew - 6, At(6), kRate, false), 26, 0.011);  // and once more
  }
}

// A source that was at its first frames when it halted is back there soon.
TEST(StreamClock, KeepsTheOutageOfASourceThatHadJustBegun) {
  for (const double before : {0.3, 0.0}) {
    StreamClock clock;
    clock.Take(before, At(0), kRate, true);
    EXPECT_NEAR(clock.Take(0, At(4), kRate, false), before + 4, 1e-9);
    EXPECT_NEAR(clock.outage(), 4, 1e-9);
    EXPECT_NEAR(clock.Take(0.01, At(4.01), kRate, false), before + 4.01, 1e-9);
    EXPECT_EQ(clock.outage(), 0);
  }
}

// A recording that is paused goes on in its own time; so do frames that a network held back.
TEST(StreamClock, AClockThatGoesOnAfterASilenceStaysTheSources) {
  StreamClock clock;
  clock.Take(20, At(0), kRate, true);
  EXPECT_EQ(clock.Take(20.01, At(4), kRate, false), 20.01);
  EXPECT_EQ(clock.Take(20.02, At(4), kRate, false), 20.02);
  EXPECT_EQ(clock.outage(), 0);
}

// Of a file that is played as fast as possible, again and again.
TEST(StreamClock, GoesOnInALoop) {
  StreamClock clock;
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(clock.Take(k / kRate, At(1e-6 * k), kRate, k % 250 == 0), k / kRate);
  }
}

TEST(StreamClock, NeverStandsOrGoesBackAtARestart) {
  StreamClock clock;
  clock.Take(20, At(0), 0, true);
  EXPECT_GT(clock.Take(0, At(0), 0, true), 20);
}

}  // namespace
}  // namespace mmm_converter
