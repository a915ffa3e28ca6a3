// SPDX-License-Identifier: MIT
#include "common/motion/held_markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int kFrames = 300;

/// Three markers of an arm that swings, two of a foot that stands, each with noise of so many m,
/// rounded to so many.
MarkerSequence Swing(double noise, double unit) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, noise);
  MarkerSequence markers({"a", "b", "c", "heel", "toe"}, kFrames, 100, 0);
  for (int k = 0; k < kFrames; ++k) {
    const double angle = std::sin(0.03 * k);
    auto frame = markers.frame(k);
    for (int i = 0; i < 3; ++i) {
      const double r = 0.2 + 0.1 * i;
      frame.col(i) << r * std::sin(angle), 0.01 * i, 1.4 - r * std::cos(angle);
    }
    frame.col(3) << 0, 0.1, 0.03;
    frame.col(4) << 0.2, 0.1, 0.02;
    for (double& x : frame.reshaped()) x = std::round((x + normal(random)) / unit) * unit;
  }
  return markers;
}

void Hold(int label, int begin, int end, MarkerSequence* markers) {
  for (int k = begin; k < end; ++k)
    markers->frame(k).col(label) = markers->frame(begin - 1).col(label);
}

TEST(HeldMarkers, AGapThatEndsWithAJumpIsFound) {
  for (const double unit : {1e-9, 1e-4, 1e-3}) {
    MarkerSequence markers = Swing(2e-4, unit);
    Hold(2, 20, 60, &markers);
    const std::vector<HeldStretch> held = FindHeldMarkers(markers);
    ASSERT_THAT(held, SizeIs(1)) << unit;
    EXPECT_EQ(held[0].label, 2);
    EXPECT_EQ(held[0].begin, 20);
    EXPECT_EQ(held[0].end, 60);
  }
}

TEST(HeldMarkers, AGapAtTheEndIsFoundByTheNeighboursThatLeave) {
  MarkerSequence markers = Swing(2e-4, 1e-6);
  Hold(2, 220, kFrames, &markers);
  const std::vector<HeldStretch> held = FindHeldMarkers(markers);
  ASSERT_THAT(held, SizeIs(1));
  EXPECT_EQ(held[0].begin, 220);
  EXPECT_EQ(held[0].end, kFrames);
}

TEST(HeldMarkers, WhatIsAtRestIsNotHeld) {
  for (const double noise : {0.0, 1e-5, 2e-4}) {
    for (const double unit : {1e-9, 1e-4, 1e-3, 1e-2}) {
      EXPECT_THAT(FindHeldMarkers(Swing(noise, unit)), IsEmpty()) << noise << " " << unit;
    }
  }
}

// All stand: a pause, or a recording that was stopped.
TEST(HeldMarkers, WhereNothingMovesNothingIsHeld) {
  MarkerSequence markers = Swing(2e-4, 1e-6);
  for (int label = 0; label < markers.num_labels(); ++label) Hold(label, 100, 150, &markers);
  EXPECT_THAT(FindHeldMarkers(markers), IsEmpty());
}

TEST(HeldMarkers, MarkersThatAreNeverSeenAreNot) {
  EXPECT_THAT(FindHeldMarkers(MarkerSequence({"a", "b"}, 20, 100, 0)), IsEmpty());
  EXPECT_THAT(FindHeldMarkers(MarkerSequence({}, 0, 100, 0)), IsEmpty());
}

}  // namespace
}  // namespace mmm_converter
