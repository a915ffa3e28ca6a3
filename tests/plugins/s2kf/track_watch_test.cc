// SPDX-License-Identifier: MIT
// The watch by itself: distances and gaps in, doubt out.
#include "plugins/s2kf/track_watch.h"

#include <gtest/gtest.h>

#include "common/support/units.h"
#include "plugins/s2kf/s2kf_settings.h"

namespace mmm_converter::s2kf {
namespace {

constexpr double kDt = 0.01;
constexpr int kWatchedMarkers = 6;
constexpr double kUsual = 0.030;  // [m]
/// Frames for which a cause of doubt lasts.
constexpr int kDoubtFrames = 20;

class TrackWatchTest : public ::testing::Test {
 protected:
  TrackWatchTest() { watch_.Start(kWatchedMarkers, kUsual, &state_); }

  bool IsInDoubt(double distance) { return watch_.IsInDoubt(z_, distance, kDt, &state_); }

  /// Frames at this distance until the track is no longer in doubt.
  int FramesInDoubt(double distance) {
    int frames = 0;
    while (IsInDoubt(distance) && frames < 1000) ++frames;
    return frames;
  }

  /// Hides the first `count` markers for so many frames, then shows them.
  void HideAndShow(int count, int frames) {
    z_.leftCols(count).setConstant(kNaN);
    for (int k = 0; k < frames; ++k) EXPECT_FALSE(IsInDoubt(kUsual));
    z_.setZero();
  }

  S2kfSettings settings_;
  TrackWatch watch_{settings_.marker_deviation, settings_.smoothing};
  TrackWatch::State state_;
  Eigen::Matrix3Xd z_ = Eigen::Matrix3Xd::Zero(3, kWatchedMarkers);
};

TEST_F(TrackWatchTest, ANewTrackIsInDoubtForTwentyFrames) {
  EXPECT_EQ(FramesInDoubt(kUsual), kDoubtFrames - 1);
  for (int k = 0; k < 500; ++k) EXPECT_FALSE(IsInDoubt(kUsual));
}

TEST_F(TrackWatchTest, DistancesAboveTheirUsualLevelAreACauseOfDoubt) {
  FramesInDoubt(kUsual);
  // Up to 15 % and 1 mm above.
  EXPECT_FALSE(IsInDoubt(1.14 * kUsual));
  EXPECT_TRUE(IsInDoubt(1.16 * kUsual + 0.0011));
  EXPECT_EQ(FramesInDoubt(kUsual), kDoubtFrames - 1);
}

TEST_F(TrackWatchTest, ALevelThatStaysIsUsualAfterAWhile) {
  FramesInDoubt(kUsual);
  EXPECT_TRUE(IsInDoubt(2 * kUsual));
  EXPECT_TRUE(state_.is_far);
  // The level needs ln(0.5 / (1 - 1 / 1.15)) = 1.3 s to come within 15 % of twice itself, and the
  // doubt lasts on.
  const int frames = FramesInDoubt(2 * kUsual);
  EXPECT_GT(frames, 100);
  EXPECT_LT(frames, 160);
  EXPECT_FALSE(state_.is_far);
}

TEST_F(TrackWatchTest, ManyMarkersBackTogetherAfterALongGapAreACauseOfDoubt) {
  FramesInDoubt(kUsual);
  HideAndShow(3, 12);
  EXPECT_TRUE(IsInDoubt(kUsual));
  EXPECT_FALSE(state_.is_far);
  EXPECT_EQ(FramesInDoubt(kUsual), kDoubtFrames - 1);
}

TEST_F(TrackWatchTest, FewMarkersOrAShortGapAreNone) {
  FramesInDoubt(kUsual);
  HideAndShow(2, 50);
  EXPECT_FALSE(IsInDoubt(kUsual));
  HideAndShow(3, 9);
  EXPECT_FALSE(IsInDoubt(kUsual));
}

TEST_F(TrackWatchTest, WhoWasHiddenAndIsSeenIsBack) {
  EXPECT_FALSE(watch_.IsBack(z_, kDt, state_));
  IsInDoubt(kUsual);
  EXPECT_TRUE(watch_.IsBack(z_, 0.3, state_));  // nothing came in between
  watch_.IsInDoubt(z_, kUsual, 0.3, &state_);
  EXPECT_FALSE(watch_.IsBack(z_, 0.3, state_));  // as usual
  const auto hide = [&](int count, int frames) {
    watch_.Start(kWatchedMarkers, kUsual, &state_);
    z_.setZero();
    z_.leftCols(count).setConstant(kNaN);
    for (int k = 0; k < frames; ++k) EXPECT_EQ(watch_.TakeHidden(z_, kDt, &state_), 0);
    z_.setZero();
  };
  hide(kWatchedMarkers, 4);
  EXPECT_FALSE(watch_.IsBack(z_, kDt, state_));
  hide(kWatchedMarkers, 7);
  EXPECT_TRUE(watch_.IsBack(z_, kDt, state_));
  z_.rightCols(4).setConstant(kNaN);  // two are too few for a person
  EXPECT_FALSE(watch_.IsBack(z_, kDt, state_));
  hide(4, 50);  // two thirds were hidden: some markers, not the person
  EXPECT_FALSE(watch_.IsBack(z_, kDt, state_));
  hide(5, 50);
  EXPECT_TRUE(watch_.IsBack(z_, kDt, state_));
  // With a gap that no frame of three markers ended there is doubt, too.
  hide(kWatchedMarkers, 50);
  FramesInDoubt(kUsual);
  hide(kWatchedMarkers, 50);
  EXPECT_TRUE(IsInDoubt(kUsual));
}

TEST_F(TrackWatchTest, ARecoveryLowersTheLevelAndEndsBeingFar) {
  FramesInDoubt(kUsual);
  IsInDoubt(3 * kUsual);
  ASSERT_TRUE(state_.is_far);
  watch_.Recovered(0.5 * kUsual, &state_);
  EXPECT_FALSE(state_.is_far);
  EXPECT_EQ(state_.usual_distance, 0.5 * kUsual);
  watch_.Recovered(kUsual, &state_);
  EXPECT_EQ(state_.usual_distance, 0.5 * kUsual);
}

TEST_F(TrackWatchTest, ACopyOfTheStateGoesOnTheSame) {
  IsInDoubt(2 * kUsual);
  TrackWatch::State copy = state_;
  for (int k = 0; k < 200; ++k) {
    const double distance = kUsual * (1 + 0.3 * (k % 7));
    EXPECT_EQ(IsInDoubt(distance), watch_.IsInDoubt(z_, distance, kDt, &copy));
  }
  EXPECT_EQ(state_.usual_distance, copy.usual_distance);
}

PostureFit::Result Fit(double cost, double mean_distance) {
  PostureFit::Result result;
  result.cost = cost;
  result.mean_distance = mean_distance;
  return result;
}

TEST_F(TrackWatchTest, AClearlyBetterPostureLowersTheCostByATenth) {
  EXPECT_FALSE(watch_.IsClearlyBetter(Fit(1, 0.030), Fit(0.91, 0.020), 40, 40));
  EXPECT_TRUE(watch_.IsClearlyBetter(Fit(1, 0.030), Fit(0.89, 0.029), 40, 40));
}

TEST_F(TrackWatchTest, AndByThreeTimesTheNoiseOfEveryMarkerWhereLittleIsLeft) {
  const TrackWatch watch(0.005, false);
  // 40 (15 mm)^2 = 9000 mm^2; what a filter lags is less.
  EXPECT_FALSE(watch.IsClearlyBetter(Fit(0.0100, 0.012), Fit(0.0011, 0.004), 40, 40));
  EXPECT_TRUE(watch.IsClearlyBetter(Fit(0.0101, 0.012), Fit(0.0010, 0.004), 40, 40));
}

TEST_F(TrackWatchTest, WithHiddenMarkersTheDistanceHasToFallByUpToTheirNoise) {
  const TrackWatch online(0.004, false);
  // A quarter hidden: by half of 4 mm.
  EXPECT_TRUE(online.IsClearlyBetter(Fit(1, 0.030), Fit(0.5, 0.0279), 30, 40));
  EXPECT_FALSE(online.IsClearlyBetter(Fit(1, 0.030), Fit(0.5, 0.0281), 30, 40));
  // A track that is smoothed: by 4 mm always.
  const TrackWatch offline(0.004, true);
  EXPECT_TRUE(offline.IsClearlyBetter(Fit(1, 0.030), Fit(0.5, 0.0259), 40, 40));
  EXPECT_FALSE(offline.IsClearlyBetter(Fit(1, 0.030), Fit(0.5, 0.0261), 40, 40));
}

TEST_F(TrackWatchTest, MarkersLeftOutAreExplainedWithFourTimesTheOthersMeanSquare) {
  EXPECT_FALSE(watch_.MayBeRight(1));
  EXPECT_TRUE(watch_.MayBeRight(2));
  // 40 markers with 1 each: two with 4 each are 8.
  EXPECT_TRUE(watch_.ExplainsLeftOut(40, 40, 8, 2));
  EXPECT_FALSE(watch_.ExplainsLeftOut(40, 40, 8.01, 2));
}

}  // namespace
}  // namespace mmm_converter::s2kf
