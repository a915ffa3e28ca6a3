// SPDX-License-Identifier: MIT
#include "common/study/slipped_markers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/io/mmm/mmm_model.h"
#include "common/support/units.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

constexpr int kSlipFrames = 500;

class SlippedMarkersTest : public ::testing::Test {
 protected:
  SlippedMarkersTest() {
    setup_.model = std::make_shared<KinematicModel>(
        ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")));
    for (int i = 0; i < pelvis_.num_labels(); ++i) {
      const int marker = setup_.model->FindMarker("MARKER_" + pelvis_.labels()[i]);
      setup_.mapping.assignments.push_back({LabelIx(i), MarkerIx(marker), 1});
    }
    // A pelvis that turns and walks, and skin that moves by 3 mm with the gait.
    for (int k = 0; k < kSlipFrames; ++k) {
      Eigen::Matrix3Xd p(3, 4);
      p << -0.13, 0.13, -0.05, 0.05, 0.1, 0.1, -0.08, -0.08, 0, 0, 0.01, 0.01;
      p(2, k % 4) += 0.003 * std::sin(0.06 * k);
      const Eigen::AngleAxisd turn(0.2 * std::sin(0.05 * k), Eigen::Vector3d(1, 2, 3).normalized());
      pelvis_.frame(k) = (turn.toRotationMatrix() * p).colwise() + Eigen::Vector3d(0, 0.01 * k, 1);
    }
  }

  TrackingSetup setup_;
  MarkerSequence pelvis_{{"LASI", "RASI", "LPSI", "RPSI"}, kSlipFrames, 100, 0};
};

TEST_F(SlippedMarkersTest, SkinThatMovesIsNoSlip) {
  EXPECT_LT(FindSlippedPelvis(setup_, pelvis_)->distance, 0.006);
}

TEST_F(SlippedMarkersTest, OneThatSlipsOutOfThePlaneTellsWhenAndByHowMuch) {
  for (int k = 250; k < kSlipFrames; ++k) pelvis_.frame(k)(2, 2) -= 0.04;
  const auto found = FindSlippedPelvis(setup_, pelvis_);
  EXPECT_NEAR(found->distance, 0.04, 0.002);
  EXPECT_NEAR(found->time, 2.5, 0.02);
  EXPECT_EQ(found->labels.size(), 4);
}

TEST_F(SlippedMarkersTest, NothingIsToldOfTooLittle) {
  for (int k = 150; k < kSlipFrames; ++k) pelvis_.frame(k).col(3).setConstant(kNaN);
  EXPECT_FALSE(FindSlippedPelvis(setup_, pelvis_).has_value());  // 1.5 s are no two windows
  setup_.mapping.assignments.pop_back();
  EXPECT_FALSE(FindSlippedPelvis(setup_, pelvis_).has_value());
}

}  // namespace
}  // namespace mmm_converter
