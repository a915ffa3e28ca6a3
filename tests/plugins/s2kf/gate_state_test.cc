// SPDX-License-Identifier: MIT
#include "plugins/s2kf/gate_state.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

namespace mmm_converter::s2kf {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kMarkers = 4;

class GateStateTest : public ::testing::Test {
 protected:
  GateStateTest() {
    state_.Start(Eigen::Vector4d(kNaN, kNaN, kNaN, 0.004));
    for (int m = 0; m < kMarkers; ++m) measured_.col(m).setConstant(m);
  }

  void Exchange(int a, int b) {
    state_.verdicts[a] = b;
    state_.verdicts[b] = a;
  }

  GateState state_;
  Matrix3Xd measured_{3, kMarkers};
  Matrix3Xd relabelled_{3, kMarkers};
  Matrix3Xd z_{3, kMarkers};
};

TEST_F(GateStateTest, SelectsExchangedMarkersAndLeavesOthersOut) {
  Exchange(0, 1);
  state_.verdicts[2] = 2;
  state_.Select(measured_, &relabelled_, &z_);
  EXPECT_EQ(z_.row(0).head(2), Eigen::RowVector2d(1, 0));
  EXPECT_TRUE(z_.col(2).array().isNaN().all());
  EXPECT_EQ(z_(0, 3), 3);
  // With what is left out.
  EXPECT_EQ(relabelled_.row(0), Eigen::RowVector4d(1, 0, 2, 3));
}

TEST_F(GateStateTest, AnExchangeWithAHiddenMarkerHidesTheOther) {
  Exchange(0, 1);
  measured_.col(1).setConstant(kNaN);
  state_.Select(measured_, &relabelled_, &z_);
  EXPECT_TRUE(z_.col(0).array().isNaN().all());
  EXPECT_EQ(z_(0, 1), 0);
}

TEST_F(GateStateTest, TheUsualOffsetIsThatOfLabelsThatAreRight) {
  state_.Advance(0.01);
  state_.Learn(0, Vector3d(0.02, 0, 0));
  EXPECT_EQ(state_.usual.col(0), Vector3d(0.02, 0, 0));
  Exchange(0, 1);
  state_.Learn(0, Vector3d(0.05, 0, 0));
  EXPECT_EQ(state_.usual.col(0), Vector3d(0.02, 0, 0));
  EXPECT_GT(state_.offset(0, 0), 0.02);
}

TEST_F(GateStateTest, AMarkerTakenBackInHasNoOffset) {
  state_.Learn(0, Vector3d(0.02, 0, 0));
  state_.Learn(1, Vector3d(0.02, 0, 0));
  state_.verdicts[0] = 0;
  state_.Open();
  EXPECT_FALSE(state_.IsAnyWrong());
  EXPECT_EQ(state_.offset.col(0).norm(), 0);
  EXPECT_GT(state_.offset.col(1).norm(), 0);
}

TEST_F(GateStateTest, ACalibratedMarkerIsFarOffSoonerAndComesBackToItsPlaceOnly) {
  for (int k = 0; k < 20; ++k) {
    state_.Advance(0.01);
    for (int m = 2; m < kMarkers; ++m) state_.Learn(m, Vector3d::Zero());
  }
  const Vector3d aside(0.04, 0, 0);
  EXPECT_FALSE(state_.IsFarOff(aside, 2));
  EXPECT_TRUE(state_.IsFarOff(aside, 3));
  for (const int m : {2, 3}) state_.verdicts[m] = m;
  const double variance = state_.variance[3];
  for (int k = 0; k < 100; ++k) state_.Advance(0.01);
  EXPECT_GT(state_.variance[2], 100 * variance);
  EXPECT_LT(state_.variance[3], 30 * variance);
  EXPECT_TRUE(state_.IsPlaceKnown(3));
  // It may have been attached anew.
  for (int k = 0; k < 101; ++k) state_.Advance(0.01);
  EXPECT_FALSE(state_.IsPlaceKnown(3));
  EXPECT_GT(state_.variance[3], 100 * variance);
}

}  // namespace
}  // namespace mmm_converter::s2kf
