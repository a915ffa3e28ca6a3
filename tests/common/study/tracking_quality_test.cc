// SPDX-License-Identifier: MIT
#include "common/study/tracking_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/support/units.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;

// Sums of a few numbers: rounding only.
constexpr double kQualityRounding = 1e-12;

class TrackingQualityTest : public ::testing::Test {
 protected:
  TrackingQualityTest() {
    reference_.model = &model_;
    reference_.joints = {0, 1};
  }

  // Joint angles by columns, root at the origin.
  static PoseTrajectory Move(const std::vector<Vector2d>& angles) {
    PoseTrajectory trajectory;
    trajectory.rate = 10;
    trajectory.joint_names = {"knee", "hip"};
    for (const Vector2d& q : angles) {
      Posture posture;
      posture.joint_angles = q;
      trajectory.postures.push_back(posture);
    }
    return trajectory;
  }

  TrackingQuality Measure(const MatrixXd& distances, const PoseTrajectory& trajectory) {
    if (reference_.hidden.cols() != distances.cols()) {
      reference_.hidden.setConstant(distances.rows(), distances.cols(), false);
    }
    reference_.optimum.setZero(distances.cols());
    return MeasureQuality(reference_, distances, trajectory, frames_);
  }

  // Of motions whose distances don't matter.
  TrackingQuality Measure(const PoseTrajectory& trajectory) {
    return Measure(MatrixXd::Zero(1, trajectory.num_frames()), trajectory);
  }

  const KinematicModel model_ = testing::StickModel();
  QualityReference reference_;
  std::vector<FrameDiagnostic> frames_;
};

TEST_F(TrackingQualityTest, DistancesAreOverAllMeasuredAndOverHiddenMarkers) {
  MatrixXd distances(2, 3);
  distances << 0.01, 0.02, kNaN,  //
      0.03, 0.06, 0.05;
  reference_.hidden.setConstant(2, 3, false);
  reference_.hidden(1, 1) = true;
  reference_.hidden(0, 2) = true;  // was not measured
  const TrackingQuality quality = Measure(distances, Move({{0, 0}, {0, 0}, {0, 0}}));
  EXPECT_NEAR(quality.all.mean, 0.17 / 5, kQualityRounding);
  EXPECT_NEAR(quality.all.max, 0.06, kQualityRounding);
  // Sorted 1 2 3 5 6 cm: 95 % is 0.8 of the way between the last two.
  EXPECT_NEAR(quality.all.p95, 0.058, kQualityRounding);
  EXPECT_NEAR(quality.all.worst_frame, 0.05, kQualityRounding);
  EXPECT_NEAR(quality.hidden.mean, 0.06, kQualityRounding);
  EXPECT_NEAR(quality.hidden.worst_frame, 0.06, kQualityRounding);
}

TEST_F(TrackingQualityTest, WithoutHiddenMarkersThereIsNoHiddenDistance) {
  const TrackingQuality quality = Measure(Move({{0, 0}}));
  EXPECT_TRUE(std::isnan(quality.hidden.mean));
  EXPECT_TRUE(std::isnan(quality.hidden.max));
}

TEST(FrameJudgement, IsRelativeToTheOptimum) {
  EXPECT_TRUE(IsGoodFrame(0.0139, 0.01));
  EXPECT_FALSE(IsGoodFrame(0.0141, 0.01));
  EXPECT_FALSE(IsLostFrame(0.0399, 0.01));
  EXPECT_TRUE(IsLostFrame(0.0401, 0.01));
  EXPECT_FALSE(IsGoodFrame(kNaN, 0.01));
  EXPECT_FALSE(IsLostFrame(kNaN, 0.01));
}

TEST_F(TrackingQualityTest, CountsFramesToConvergeAndLostFrames) {
  const PoseTrajectory still = Move({{0, 0}, {0, 0}, {0, 0}, {0, 0}});
  MatrixXd distances(1, 4);
  distances << 0.5, 0.003, 0.001, 0.021;  // the optimum is 0: good up to 2 mm, lost beyond 20 mm
  const TrackingQuality quality = Measure(distances, still);
  EXPECT_EQ(quality.first_good, 2);
  EXPECT_EQ(quality.lost_frames, 2);
  EXPECT_FALSE(Measure(distances.array() + 1, still).first_good.has_value());
}

TEST_F(TrackingQualityTest, JitterIsTheRmsJointAcceleration) {
  std::vector<Vector2d> angles;
  angles.reserve(6);
  for (int k = 0; k < 6; ++k) angles.emplace_back(0.5 * 3 * k * k * 0.01, 0.1);  // 3 rad/s^2, 0
  EXPECT_NEAR(Measure(Move(angles)).jitter, 3 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(Measure(Move({{0.1, 0.1}, {0.1, 0.1}, {0.1, 0.1}})).jitter, 0);
  EXPECT_EQ(Measure(Move({{0, 0}, {1, 1}})).jitter, 0);
}

TEST_F(TrackingQualityTest, LargestStepIsOfAnyJointInEitherDirection) {
  EXPECT_NEAR(Measure(Move({{0, 0}, {0.1, -0.4}, {0.3, -0.4}})).largest_step, 0.4,
              kQualityRounding);
}

TEST_F(TrackingQualityTest, LimitShareCountsSamplesOnEitherLimit) {
  // Limits are -1 and 1; a thousandth of the range is on the limit.
  EXPECT_EQ(Measure(Move({{1, 0}, {-0.999, 0.99}})).limit_share, 0.5);
}

TEST_F(TrackingQualityTest, OnlyComparedJointsCount) {
  reference_.joints = {0};
  EXPECT_EQ(Measure(Move({{0, 0}, {0, 1}})).largest_step, 0);
}

TEST_F(TrackingQualityTest, TruthGivesJointCentersAndAngles) {
  const PoseTrajectory truth = Move({{0, 0}, {0, 0}});
  reference_.truth = &truth;
  const TrackingQuality quality = Measure(Move({{0.2, 0}, {0, -0.2}}));
  EXPECT_NEAR(quality.joint_angle_error, 0.4 / 4, kQualityRounding);
  // Of two joints and frames only the hip's centre, 0.5 m above the knee, moved once.
  EXPECT_NEAR(quality.joint_center_error, 2 * 0.5 * std::sin(0.1) / 4, kQualityRounding);
  reference_.truth = nullptr;
  EXPECT_TRUE(std::isnan(Measure(Move({{0.2, 0}})).joint_angle_error));
}

TEST_F(TrackingQualityTest, ReliabilityIsTheShareWithinTheDeviations) {
  const PoseTrajectory truth = Move({{0, 0}, {0, 0}});
  reference_.truth = &truth;
  PoseTrajectory estimated = Move({{0.2, 0.05}, {0, -0.1}});
  EXPECT_TRUE(Measure(estimated).reliability.empty());  // it claims nothing
  estimated.standard_deviations = Eigen::MatrixXd::Constant(6 + 2, 2, 0.09);
  const TrackingQuality quality = Measure(estimated);
  EXPECT_EQ(quality.ReliabilityAt(0.25), 0.25);
  EXPECT_EQ(quality.ReliabilityAt(1), 0.5);
  EXPECT_EQ(quality.ReliabilityAt(2), 0.75);
  EXPECT_EQ(quality.ReliabilityAt(3), 1);
  EXPECT_EQ(Summarize({quality, quality}).ReliabilityAt(2), 0.75);
  EXPECT_NEAR(NormalShareWithin(1), 0.6827, 1e-4);
  // Joints that have no deviation do not count.
  estimated.standard_deviations.row(6).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(Measure(estimated).ReliabilityAt(2), 1);
}

TEST_F(TrackingQualityTest, TimesLeaveOutFramesThatTookNone) {
  frames_.resize(4);
  frames_[1].seconds = 0.001;
  frames_[2].seconds = 0.002;
  frames_[3].seconds = 0.003;
  const TrackingQuality quality = Measure(Move({{0, 0}, {0, 0}, {0, 0}, {0, 0}}));
  EXPECT_NEAR(quality.median_seconds, 0.002, kQualityRounding);
  EXPECT_NEAR(quality.p99_seconds, 0.00298, kQualityRounding);
}

TEST(Summarize, TakesMeansAndLargestValues) {
  TrackingQuality a;
  a.all = {1, 2, 3, 4};
  a.hidden = {kNaN, kNaN, kNaN, kNaN};
  a.first_good = 4;
  a.lost_frames = 2;
  a.largest_step = 0.5;
  TrackingQuality b;
  b.all = {3, 6, 1, 9};
  b.hidden = {5, 5, 5, 5};
  b.first_good = 6;
  b.largest_step = 0.1;
  const TrackingQuality both = Summarize({a, b});
  EXPECT_EQ(both.all.mean, 2);
  EXPECT_EQ(both.all.p95, 4);
  EXPECT_EQ(both.all.max, 3);
  EXPECT_EQ(both.all.worst_frame, 9);
  EXPECT_EQ(both.hidden.mean, 5);
  EXPECT_EQ(both.first_good, 5);
  EXPECT_EQ(both.lost_frames, 1);
  EXPECT_EQ(both.largest_step, 0.5);
  b.first_good.reset();
  EXPECT_FALSE(Summarize({a, b}).first_good.has_value());
}

}  // namespace
}  // namespace mmm_converter
