// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "common/support/error.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter {
namespace {

MarkerSequence FullSequence(int num_labels, int num_frames) {
  std::vector<std::string> labels(num_labels);
  for (int i = 0; i < num_labels; ++i) {
    labels[i] = std::string(1, 'M').append(std::to_string(i));
  }
  MarkerSequence sequence(labels, num_frames, 100, 0);
  for (int k = 0; k < num_frames; ++k) {
    for (int i = 0; i < num_labels; ++i) sequence.frame(k).col(i) = Eigen::Vector3d(k, i, 1);
  }
  return sequence;
}

int NumHidden(const MarkerSequence& sequence, int k) {
  int hidden = 0;
  for (int i = 0; i < sequence.num_labels(); ++i) hidden += !IsSeen(sequence.frame(k).col(i));
  return hidden;
}

bool Same(const MarkerSequence& a, const MarkerSequence& b) {
  for (int k = 0; k < a.num_frames(); ++k) {
    for (int i = 0; i < a.num_labels(); ++i) {
      const bool seen = IsSeen(a.frame(k).col(i));
      if (seen != IsSeen(b.frame(k).col(i))) return false;
      if (seen && a.frame(k).col(i) != b.frame(k).col(i)) return false;
    }
  }
  return true;
}

TEST(OcclusionTest, RandomOcclusionHidesTheShareThatItsParametersSay) {
  const MarkerSequence hidden = testing::OccludeAtRandom(FullSequence(50, 5000), {0.005, 100}, 1);
  double mean = 0;
  for (int k = 500; k < 5000; ++k) mean += NumHidden(hidden, k) / 4500.0;
  // Visible for 1/p - 1 whole frames, then hidden for 100: 100 / 299 of 50 markers. Some 4500 / 300
  // independent periods of 50 markers: standard deviation 50 * sqrt(0.22 / 750) = 0.9.
  EXPECT_NEAR(mean, 50 * 100.0 / 299, 2.7);
}

TEST(OcclusionTest, ShareIsHiddenInEveryFrameAndWanders) {
  const MarkerSequence hidden = testing::OccludeShare(FullSequence(53, 2000), 0.33, 100, 2);
  Eigen::VectorXi frames_hidden = Eigen::VectorXi::Zero(53);
  for (int k = 0; k < 2000; ++k) {
    ASSERT_EQ(NumHidden(hidden, k), 17);  // round(0.33 * 53)
    for (int i = 0; i < 53; ++i) frames_hidden[i] += !IsSeen(hidden.frame(k).col(i));
  }
  EXPECT_GT(frames_hidden.minCoeff(), 0);
  EXPECT_LT(frames_hidden.maxCoeff(), 2000);
}

TEST(OcclusionTest, ShareOfNothingAndOfAll) {
  EXPECT_TRUE(Same(testing::OccludeShare(FullSequence(5, 50), 0, 10, 3), FullSequence(5, 50)));
  EXPECT_EQ(NumHidden(testing::OccludeShare(FullSequence(5, 50), 1, 10, 3), 49), 5);
}

TEST(OcclusionTest, SeedDecides) {
  const MarkerSequence full = FullSequence(20, 300);
  EXPECT_TRUE(Same(testing::OccludeAtRandom(full, {}, 4), testing::OccludeAtRandom(full, {}, 4)));
  EXPECT_FALSE(Same(testing::OccludeAtRandom(full, {}, 4), testing::OccludeAtRandom(full, {}, 5)));
  EXPECT_TRUE(
      Same(testing::OccludeShare(full, 0.5, 30, 4), testing::OccludeShare(full, 0.5, 30, 4)));
  EXPECT_FALSE(
      Same(testing::OccludeShare(full, 0.5, 30, 4), testing::OccludeShare(full, 0.5, 30, 5)));
}

TEST(OcclusionTest, HidesAndSwapsExactlyTheFramesThatAreNamed) {
  const MarkerSequence full = FullSequence(4, 10);
  const MarkerSequence hidden = testing::HideMarkers(full, {"M1", "M3"}, 2, 5);
  const MarkerSequence gone = testing::HideAllMarkers(full, 2, 5);
  const MarkerSequence swapped = testing::SwapMarkers(full, "M0", "M2", 2, 5);
  for (int k = 0; k < 10; ++k) {
    const bool inside = k >= 2 && k < 5;
    EXPECT_EQ(IsSeen(hidden.frame(k).col(1)), !inside);
    EXPECT_EQ(IsSeen(hidden.frame(k).col(3)), !inside);
    EXPECT_TRUE(IsSeen(hidden.frame(k).col(0)));
    EXPECT_EQ(NumHidden(gone, k), inside ? 4 : 0);
    EXPECT_EQ(swapped.frame(k)(1, 0), inside ? 2 : 0);
    EXPECT_EQ(swapped.frame(k)(1, 2), inside ? 0 : 2);
    EXPECT_EQ(swapped.frame(k)(1, 1), 1);
  }
}

TEST(OcclusionTest, UnknownLabelIsNamed) {
  try {
    testing::HideMarkers(FullSequence(2, 2), {"M7"}, 0, 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'M7'"), std::string::npos);
  }
}

}  // namespace
}  // namespace mmm_converter
