// SPDX-License-Identifier: MIT
#include "common/angles/normal_bands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr double kSameValue = 1e-9;  // rounding of a double
constexpr const char* kHeader = "joint,angle,percent,mean_degrees,sd_degrees\n";

NormalBands Parse(const std::string& text) { return ParseNormalBands(text, "norm.csv"); }

std::string MessageOf(const std::string& text) {
  try {
    Parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(NormalBands, AreLinearBetweenTheirRows) {
  const NormalBands normal =
      Parse("# Source: Smith 2010, 24 adults\n# at 1.3 m/s\n" + std::string(kHeader) +
            "knee,flexion,0,10,2\nknee,flexion,50,20,4\nknee,flexion,100,10,2\n");
  EXPECT_EQ(normal.source, "Smith 2010, 24 adults at 1.3 m/s");
  ASSERT_THAT(normal.bands, SizeIs(1));
  EXPECT_NEAR(normal.bands[0].mean[0], 10, kSameValue);
  EXPECT_NEAR(normal.bands[0].mean[25], 15, kSameValue);
  EXPECT_NEAR(normal.bands[0].deviation[75], 3, kSameValue);
  EXPECT_NEAR(normal.bands[0].mean[100], 10, kSameValue);
}

TEST(NormalBands, ColumnsOfOtherOrderSeparatorAndMoreAreRead) {
  const NormalBands normal = Parse(
      "strides;percent;side;angle;joint;mean;sd\n"
      "7;0;left;Flexion;Hip;30;5\n7;100;left;Flexion;Hip;32;5\n7;0;;Flexion;Hip;1;5\n"
      "7;100;;Flexion;Hip;1;5\n");
  EXPECT_EQ(normal.source, "norm.csv");
  ASSERT_NE(normal.Find("hip", "flexion", Side::kLeft), nullptr);
  EXPECT_NEAR(normal.Find("hip", "flexion", Side::kLeft)->mean[50], 31, kSameValue);
  EXPECT_NEAR(normal.Find("hip", "flexion", Side::kRight)->mean[50], 1, kSameValue);  // of both
  EXPECT_EQ(normal.Find("hip", "adduction", Side::kLeft), nullptr);
}

TEST(NormalBands, WhatIsWrongIsSaidWithItsLine) {
  const std::string head = kHeader;
  EXPECT_THAT(MessageOf("a,b\n1,2\n"),
              HasSubstr("norm.csv:1: no bands of normal gait: the header"));
  EXPECT_THAT(MessageOf(""), HasSubstr("the header must name joint"));
  EXPECT_THAT(MessageOf(head), HasSubstr("no row follows"));
  EXPECT_THAT(MessageOf(head + "knee,flexion,0,x,1\n"), HasSubstr("norm.csv:2: mean is \"x\""));
  EXPECT_THAT(MessageOf(head + "knee,flexion,0\n"), HasSubstr("norm.csv:2: 3 cells"));
  EXPECT_THAT(MessageOf(head + "knee,flexion,0,1,-1\n"), HasSubstr("sd is negative"));
  EXPECT_THAT(MessageOf(head + "knee,flexion,0,1,1\nknee,flexion,90,1,1\n"),
              HasSubstr("reaches from 0 to 90 %"));
  EXPECT_THAT(MessageOf(head + "knee,flexion,0,1,1\nknee,flexion,0,1,1\n"),
              HasSubstr("norm.csv:3: knee flexion at 0 % follows 0 %"));
  EXPECT_THAT(MessageOf("side," + head + "up,knee,flexion,0,1,1\n"), HasSubstr("side is \"up\""));
}

TEST(NormalBands, NamesThatAreNoUtf8AreReadAsText) {
  const NormalBands normal =
      Parse("# \xff\n" + std::string(kHeader) + "kn\xe9,f,0,1,1\nkn\xe9,f,100,1,1\n");
  EXPECT_EQ(normal.bands[0].joint, "kn\xc3\xa9");
  EXPECT_EQ(normal.source, "\xc3\xbf");
}

TEST(GaitProfile, MiddleOfTheBodyHasTheSignOfTheSide) {
  EXPECT_EQ(OwnSideSign("hip", "internal rotation", Side::kRight), 1);
  EXPECT_EQ(OwnSideSign("pelvis", "tilt", Side::kRight), 1);
  for (const char* motion : {"obliquity", "rotation", "lateral bending"}) {
    EXPECT_EQ(OwnSideSign("pelvis", motion, Side::kLeft),
              -OwnSideSign("pelvis", motion, Side::kRight));
  }
  EXPECT_EQ(OwnSideSign("pelvis", "obliquity", Side::kLeft), 1);  // the left side up
  EXPECT_EQ(OwnSideSign("pelvis", "rotation", Side::kRight), 1);  // to the left: right side forward
}

TEST(GaitProfile, ScoreIsTheRootMeanSquareOfTheDifference) {
  NormalBand normal;
  normal.joint = "pelvis";
  normal.motion = "obliquity";
  normal.mean.fill(2);
  GaitCycle stride;
  stride.angle = {"pelvis", "", "obliquity"};
  stride.side = Side::kRight;
  for (int i = 0; i < GaitCycle::kSamples; ++i) stride.mean[i] = (i % 2 == 0 ? -5 : 1) / kDegrees;
  // Of its own side 5 and -1 degrees: 3 from normal at each sample.
  EXPECT_NEAR(VariableScore(stride, normal), 3, kSameValue);
  stride.mean[7] = std::nan("");
  EXPECT_TRUE(std::isnan(VariableScore(stride, normal)));
}

TEST(GaitProfile, ABandOfASideIsAsItWasExported) {
  NormalBand normal;
  normal.joint = "pelvis";
  normal.motion = "rotation";
  normal.side = Side::kLeft;
  normal.mean.fill(-4);  // of the own side, which turns back
  GaitCycle stride;
  stride.angle = {"pelvis", "", "rotation"};
  stride.side = Side::kLeft;
  stride.mean.fill(4 / kDegrees);
  EXPECT_NEAR(VariableScore(stride, normal), 0, kSameValue);
}

TEST(NormalBands, InRadiansAreRefused) {
  const std::string head = kHeader;
  EXPECT_THAT(MessageOf(head + "knee,flexion,0,0.1,0.1\nknee,flexion,100,1.1,0.1\n"),
              HasSubstr("norm.csv: all angles are within 2 degrees"));
  EXPECT_EQ(MessageOf(head + "pelvis,obliquity,0,1,1\npelvis,obliquity,100,-1,1\n"), "no error");
}

TEST(NormalBands, TellWhichAnglesScoresLack) {
  const NormalBands normal =
      Parse(std::string(kHeader) + "knee,flexion,0,10,2\nknee,flexion,100,10,2\n");
  const std::vector<std::string> lacking = LackingAngles(normal);
  EXPECT_EQ(lacking.size(), kProfileAngles.size() - 1);
  EXPECT_EQ(lacking.front(), "pelvis tilt");
}

}  // namespace
}  // namespace mmm_converter
