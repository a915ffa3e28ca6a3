// SPDX-License-Identifier: MIT
#include "common/motion/marker_residuals.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mmm_converter {
namespace {

Eigen::MatrixXd ThreeMarkersFourFrames() {
  Eigen::MatrixXd residuals(3, 4);
  residuals << 1, 2, 3, kNaN,  //
      5, 5, kNaN, kNaN,        //
      kNaN, kNaN, kNaN, kNaN;
  return residuals;
}

TEST(MarkerResiduals, OverAllMarkersAndFrames) {
  const ResidualSummary all = SummarizeResiduals(ThreeMarkersFourFrames());
  EXPECT_EQ(all.seen, 5);
  EXPECT_DOUBLE_EQ(all.mean, 3.2);
  EXPECT_EQ(all.median, 3);
  EXPECT_EQ(all.p95, 5);
  EXPECT_EQ(all.max, 5);
}

TEST(MarkerResiduals, PerMarkerAndPerFrame) {
  const Eigen::MatrixXd residuals = ThreeMarkersFourFrames();
  const auto markers = SummarizeEachMarker(residuals);
  ASSERT_EQ(markers.size(), 3u);
  EXPECT_EQ(markers[0].seen, 3);
  EXPECT_EQ(markers[0].mean, 2);
  EXPECT_DOUBLE_EQ(markers[0].p95, 2.9);
  EXPECT_EQ(markers[1].max, 5);
  EXPECT_EQ(markers[2].seen, 0);
  EXPECT_TRUE(std::isnan(markers[2].mean));

  const Eigen::VectorXd frames = MeanOfEachFrame(residuals);
  ASSERT_EQ(frames.size(), 4);
  EXPECT_EQ(frames[0], 3);
  EXPECT_EQ(frames[1], 3.5);
  EXPECT_EQ(frames[2], 3);
  EXPECT_TRUE(std::isnan(frames[3]));
  EXPECT_EQ(FramesWithMissingMarkers(residuals), 4);
  EXPECT_EQ(FramesWithMissingMarkers(residuals.topLeftCorner(2, 3)), 1);
}

TEST(MarkerResiduals, FramesBeforeThePersonIsSeen) {
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Constant(2, 4, std::nan(""));
  EXPECT_EQ(FramesBeforeFirstSeen(residuals), 0);
  residuals(1, 2) = 0;
  EXPECT_EQ(FramesBeforeFirstSeen(residuals), 2);
  residuals(0, 0) = 1;
  EXPECT_EQ(FramesBeforeFirstSeen(residuals), 0);
}

TEST(MarkerResiduals, NothingAtAll) {
  EXPECT_EQ(SummarizeResiduals(Eigen::MatrixXd(3, 0)).seen, 0);
  EXPECT_TRUE(SummarizeEachMarker(Eigen::MatrixXd(0, 3)).empty());
  EXPECT_EQ(MeanOfEachFrame(Eigen::MatrixXd(0, 3)).size(), 3);
}

}  // namespace
}  // namespace mmm_converter
