// SPDX-License-Identifier: MIT
#include "common/motion/hiding.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

constexpr int kHidingMarkers = 50;
constexpr int kHidingFrames = 675;

TEST(Hiding, NoneHidesNothing) {
  EXPECT_FALSE(DrawHidden({}, kHidingMarkers, kHidingFrames, 1).any());
}

TEST(Hiding, TheSeedDecides) {
  const Hiding paper{HidingModel::kPaper, 0.005, 100};
  const HiddenMarkers first = DrawHidden(paper, kHidingMarkers, kHidingFrames, 1);
  EXPECT_EQ(first, DrawHidden(paper, kHidingMarkers, kHidingFrames, 1));
  EXPECT_NE(first, DrawHidden(paper, kHidingMarkers, kHidingFrames, 2));
}

TEST(Hiding, StationaryHidesTheShareInEveryFrame) {
  const HiddenMarkers hidden =
      DrawHidden({HidingModel::kStationary, 0.3, 100}, kHidingMarkers, kHidingFrames, 1);
  const Eigen::VectorXd counts = hidden.cast<double>().colwise().sum();
  EXPECT_EQ(counts.minCoeff(), 15);
  EXPECT_EQ(counts.maxCoeff(), 15);
}

TEST(Hiding, PaperHidesAThirdOnceItIsStationary) {
  double sum = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    const HiddenMarkers hidden =
        DrawHidden({HidingModel::kPaper, 0.005, 100}, kHidingMarkers, kHidingFrames, run);
    sum += hidden.rightCols(300).cast<double>().mean() / kRuns;
  }
  // p m / (1 + p m) = 1/3; 40 runs of 50 markers that hide about twice each: 0.01 is 1 sigma.
  EXPECT_NEAR(sum, 1.0 / 3, 0.03);
}

TEST(Hiding, HidesTheLabelsGivenAndNoOther) {
  MarkerSequence recording({"A", "B", "C"}, 2, 100, 0);
  for (int k = 0; k < 2; ++k) recording.frame(k).setOnes();
  HiddenMarkers hidden(2, 2);
  hidden << true, false,  //
      false, true;
  const MarkerSequence seen = WithoutHidden(recording, {LabelIx(2), LabelIx(0)}, hidden);
  EXPECT_FALSE(IsSeen(seen.frame(0).col(2)));
  EXPECT_TRUE(IsSeen(seen.frame(1).col(2)));
  EXPECT_TRUE(IsSeen(seen.frame(0).col(0)));
  EXPECT_FALSE(IsSeen(seen.frame(1).col(0)));
  EXPECT_TRUE(IsSeen(seen.frame(0).col(1)));
  EXPECT_TRUE(IsSeen(seen.frame(1).col(1)));
}

}  // namespace
}  // namespace mmm_converter
