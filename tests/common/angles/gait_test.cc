// SPDX-License-Identifier: MIT
#include "common/angles/gait.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "common/angles/gait_table.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr double kSame = 1e-9;
constexpr double kRate = 100;
constexpr int kFrames = 301;
constexpr double kStride = 1.2;  // [m] in a second
constexpr double kWidth = 0.2;   // [m]
constexpr double kStance = 0.6;  // of a second
constexpr double kMore = 0.1;    // [rad] by which the second stride differs from the first

/// A walk along x: the left foot comes to the ground at 0.5, 1.5 and 2.5 s, the right one half a
/// second later each.
class GaitTest : public ::testing::Test {
 protected:
  GaitTest() {
    feet_.rate = angles_.rate = kRate;
    for (const Side side : kSides) {
      const bool is_left = side == Side::kLeft;
      const double first = is_left ? 0.5 : 1;
      FootPath& foot = feet_.feet[static_cast<std::size_t>(side)];
      foot.heel.setZero(3, kFrames);
      for (int k = 0; k < kFrames; ++k) {
        const double steps = std::floor(k / kRate - first + 1e-6);
        foot.heel.col(k) << kStride * (first + steps), is_left ? kWidth : 0, 0;
      }
      foot.toe = foot.heel;
      foot.toe.row(0).array() += 0.25;
      for (double begin = first; begin < 2.6; begin += 1) {
        FootContact contact;
        contact.side = side;
        contact.begin = begin;
        if (begin + kStance < 3) contact.end = begin + kStance;
        contact.begin_deviation = contact.end_deviation = 0.01;
        contacts_.contacts.push_back(contact);
      }
    }
    angles_.angles = {
        {"knee", "left", "flexion"}, {"pelvis", "", "tilt"}, {"pelvis", "", "rotation"}};
    angles_.values.setZero(3, kFrames);
    angles_.values.row(2).setConstant(0.1 - std::numbers::pi / 2);  // faces x, to the left by 0.1
    angles_.deviations.setConstant(3, kFrames, 0.02);
    known_[0].assign(kFrames, true);
    known_[1] = known_[0];
    for (int k = 0; k < kFrames; ++k) {
      const double t = k / kRate - 0.5;
      angles_.values(0, k) =
          std::cos(2 * std::numbers::pi * t) + (t > 1 + 1e-6 && t < 2 - 1e-6 ? kMore : 0);
    }
  }

  FootMotion feet_;
  Contacts contacts_;
  AnatomicalAngles angles_;
  KnownLegs known_;
};

TEST_F(GaitTest, FiguresOfStrides) {
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  ASSERT_THAT(gait.strides, SizeIs(3));
  for (const Stride& one : gait.strides) {
    EXPECT_NEAR(one.time(), 1, kSame);
    EXPECT_NEAR(one.cadence(), 120, 1e-6);
    EXPECT_NEAR(one.length, kStride, kSame);
    EXPECT_NEAR(one.speed(), kStride, kSame);
    EXPECT_NEAR(one.foot_off, kStance, kSame);
    EXPECT_NEAR(one.step_time, 0.5, kSame);
    EXPECT_NEAR(one.step_length, kStride / 2, kSame);
    EXPECT_NEAR(one.step_width, kWidth, kSame);
    EXPECT_NEAR(one.time_deviation, 0.01 * std::sqrt(2), kSame);
    EXPECT_NEAR(one.foot_off_deviation, 0.01 * std::sqrt(2), kSame);
    EXPECT_NEAR(one.double_support_deviation, 0.02, kSame);
  }
  EXPECT_EQ(gait.strides[2].side, Side::kRight);
}

TEST_F(GaitTest, StepsAreAsWideAsHeelsAreApart) {
  // Toes point outwards; then the feet cross.
  for (const Side side : kSides) {
    FootPath& foot = feet_.feet[static_cast<std::size_t>(side)];
    foot.toe.row(1).array() += side == Side::kLeft ? 0.05 : -0.05;
  }
  for (const Stride& one : AnalyzeGait(feet_, contacts_, angles_, known_).strides) {
    EXPECT_NEAR(one.step_width, kWidth, kSame);
  }
  for (Eigen::Matrix3Xd* path : {&feet_.feet[0].heel, &feet_.feet[0].toe}) {
    path->row(1).array() -= 2 * kWidth;
  }
  for (const Stride& one : AnalyzeGait(feet_, contacts_, angles_, known_).strides) {
    EXPECT_NEAR(one.step_width, -kWidth, kSame);
  }
}

TEST_F(GaitTest, AnglesOverTheCycle) {
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  ASSERT_THAT(gait.cycles, SizeIs(5));  // the knee, and the pelvis over either foot's strides
  const GaitCycle& knee = gait.cycles[0];
  EXPECT_EQ(knee.strides, 2);
  for (int i = 2; i < GaitCycle::kSamples - 1; ++i) {
    EXPECT_NEAR(knee.mean[i], std::cos(2 * std::numbers::pi * i / 100) + kMore / 2, kSame) << i;
    EXPECT_NEAR(knee.deviation[i], kMore / std::sqrt(2), kSame) << i;
  }
  EXPECT_EQ(gait.cycles[3].strides, 1);
  EXPECT_TRUE(std::isnan(gait.cycles[3].deviation[50]));
  EXPECT_NEAR(knee.uncertainty[50], 0.02, kSame);
  EXPECT_NEAR(gait.cycles[2].mean[50], 0.1, kSame);  // against the way
}

TEST_F(GaitTest, StridesThatAreHardlyKnownDoNotCount) {
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  const double nan = std::nan("");
  angles_.values.row(0).segment(55, 10).setConstant(nan);  // a tenth of the first stride
  const GaitCycle first = CyclesOf(angles_, gait.strides)[0];
  EXPECT_EQ(first.strides, 2);
  EXPECT_NEAR(first.mean[50], -1 + kMore / 2, kSame);
  EXPECT_NEAR(first.mean[10], std::cos(0.2 * std::numbers::pi) + kMore, kSame);
  EXPECT_TRUE(std::isnan(first.deviation[10]));             // of one
  angles_.values.row(0).segment(160, 60).setConstant(nan);  // and six of the second
  const GaitCycle one = CyclesOf(angles_, gait.strides)[0];
  EXPECT_EQ(one.strides, 1);
  EXPECT_NEAR(one.mean[50], -1, kSame);
  EXPECT_TRUE(std::isnan(one.mean[10]));
  angles_.values.row(0).setConstant(nan);
  EXPECT_STREQ(CyclesOf(angles_, gait.strides)[0].angle.joint, "pelvis");
}

TEST_F(GaitTest, StridesOfAHiddenLegAreLeftOut) {
  known_[1][70] = false;  // in the left foot's first stride
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  EXPECT_THAT(gait.strides, SizeIs(2));
  EXPECT_EQ(gait.left_out, 1);
}

TEST_F(GaitTest, LengthsAreOnTheBelt) {
  const Gait ground = AnalyzeGait(feet_, contacts_, angles_, known_);
  for (FootPath& foot : feet_.feet) {
    foot.belt << -0.9, 0, 0;
    for (int k = 0; k < kFrames; ++k) {
      foot.heel.col(k) += k / kRate * foot.belt;
      foot.toe.col(k) += k / kRate * foot.belt;
    }
  }
  const Gait belt = AnalyzeGait(feet_, contacts_, angles_, known_);
  ASSERT_EQ(belt.strides.size(), ground.strides.size());
  for (std::size_t i = 0; i < belt.strides.size(); ++i) {
    EXPECT_NEAR(belt.strides[i].length, ground.strides[i].length, kSame);
    EXPECT_NEAR(belt.strides[i].step_length, ground.strides[i].step_length, kSame);
  }
}

TEST_F(GaitTest, StridesOverATurnAreLeftOut) {
  feet_.feet[0].toe.rightCols(60) = feet_.feet[0].heel.rightCols(60);
  feet_.feet[0].toe.rightCols(60).row(1).array() += 0.25;  // to the left from 2.41 s on
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  EXPECT_THAT(gait.strides, SizeIs(2));
  EXPECT_EQ(gait.turns, 1);
}

TEST_F(GaitTest, WhoWalksSlowlyHasStridesOfSixSeconds) {
  const double slow = 4;
  feet_.rate /= slow;
  angles_.rate /= slow;
  for (FootContact& one : contacts_.contacts) {
    *one.begin *= slow;
    if (one.end) *one.end *= slow;
  }
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  ASSERT_THAT(gait.strides, SizeIs(3));
  EXPECT_NEAR(gait.strides[0].time(), slow, kSame);
}

TEST_F(GaitTest, KindsOfGait) {
  EXPECT_EQ(AnalyzeGait(feet_, contacts_, angles_, known_).kind, GaitKind::kWalking);
  EXPECT_NEAR(AnalyzeGait(feet_, contacts_, angles_, known_).strides[1].double_support, 0.2, kSame);
  for (FootPath& foot : feet_.feet) foot.toe.row(0).array() -= 0.5;
  EXPECT_EQ(AnalyzeGait(feet_, contacts_, angles_, known_).kind, GaitKind::kBackwards);
  for (FootContact& one : contacts_.contacts) {
    if (one.end) *one.end -= 0.3;
  }
  const Gait run = AnalyzeGait(feet_, contacts_, angles_, known_);
  EXPECT_EQ(run.kind, GaitKind::kRunning);
  EXPECT_TRUE(std::isnan(run.strides[0].double_support));
  EXPECT_NEAR(run.strides[0].step_length, kStride / 2, kSame);
}

TEST_F(GaitTest, RampsAndStairsAreWhereEachFootRises) {
  FootPath& left = feet_.feet[0];
  for (Eigen::Matrix3Xd* path : {&left.heel, &left.toe}) path->row(2).array() += 0.15;
  EXPECT_EQ(AnalyzeGait(feet_, contacts_, angles_, known_).kind, GaitKind::kWalking);
  for (const GaitKind kind : {GaitKind::kRamp, GaitKind::kStairs}) {
    for (FootPath& foot : feet_.feet) {
      const Eigen::RowVectorXd rise = foot.heel.row(0) * 0.3 / kStride;
      for (Eigen::Matrix3Xd* path : {&foot.heel, &foot.toe}) path->row(2) += rise;
    }
    EXPECT_EQ(AnalyzeGait(feet_, contacts_, angles_, known_).kind, kind);
  }
}

TEST_F(GaitTest, StandingIsNoStride) {
  for (FootContact& one : contacts_.contacts) *one.begin *= 4;
  EXPECT_THAT(AnalyzeGait(feet_, contacts_, angles_, known_).strides, SizeIs(0));
}

TEST_F(GaitTest, Tables) {
  const Gait gait = AnalyzeGait(feet_, contacts_, angles_, known_);
  const std::string csv = FormatGaitCsv({{"walk", &gait}});
  EXPECT_THAT(csv, StartsWith("trial,joint,side,angle,unit,percent,mean,sd,uncertainty,strides\n"));
  EXPECT_THAT(csv,
              HasSubstr("\nwalk,knee,left,flexion,degrees,50,-54.430991,4.051423,1.145916,2\n"));
  EXPECT_THAT(csv, HasSubstr("\nwalk,pelvis,right,tilt,degrees,100,0,,1.145916,1\n"));
  const auto json = nlohmann::json::parse(FormatGaitJson({{"walk", &gait}}));
  EXPECT_NEAR(json["summary"]["left"]["cadence_steps_per_min"]["mean"], 120, 1e-6);
  EXPECT_EQ(json["summary"]["left"]["step_width_m"]["strides"], 2);
  EXPECT_TRUE(json["summary"]["right"]["step_width_m"]["sd"].is_null());
  EXPECT_THAT(json["strides"], SizeIs(3));
  EXPECT_EQ(json["strides_left_out"], 0);
  EXPECT_THAT(json["cycles"][0]["mean_degrees"], SizeIs(101));
}

TEST_F(GaitTest, WithoutContactsNothing) {
  const Gait gait = AnalyzeGait(feet_, {}, angles_, known_);
  EXPECT_THAT(gait.cycles, SizeIs(0));
  const auto json = nlohmann::json::parse(FormatGaitJson({{"walk", &gait}}));
  EXPECT_TRUE(json["summary"]["left"]["cadence_steps_per_min"]["mean"].is_null());
}

}  // namespace
}  // namespace mmm_converter
