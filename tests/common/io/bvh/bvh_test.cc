// SPDX-License-Identifier: MIT
#include "common/io/bvh/bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHead = R"(HIERARCHY
ROOT a b
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT c {
    OFFSET 0 2 0
    CHANNELS 1 Xrotation
    End Site
    { OFFSET 0 0 3 }
  }
}
MOTION
)";

Bvh Parse(const std::string& text, Warnings* warnings = nullptr) {
  return ParseBvh(text, "input", warnings);
}

Bvh ParseMotion(const std::string& motion, Warnings* warnings = nullptr) {
  return Parse(kHead + motion, warnings);
}

std::string Refusal(const std::string& text) {
  try {
    Parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Eigen::Matrix3Xd Places(const Bvh& bvh, int frame = 0) {
  Eigen::Matrix3Xd p;
  std::vector<Eigen::Matrix3d> R;
  PoseBvh(bvh, frame, &p, &R);
  return p;
}

TEST(Bvh, TurnsByItsChannelsInTheirOrder) {
  const Bvh bvh = ParseMotion("Frames: 1\nFrame Time: 0.01\n1 2 3 90 90 0 90\n");
  ASSERT_EQ(bvh.joints.size(), 3U);
  EXPECT_EQ(bvh.joints[0].name, "a b");
  EXPECT_EQ(bvh.rate, 100);
  const Eigen::Matrix3Xd p = Places(bvh);
  EXPECT_LT((p.col(0) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  // Rz(90) Rx(90) takes y to z, and z to x.
  EXPECT_LT((p.col(1) - Eigen::Vector3d(1, 2, 5)).norm(), 1e-12);
  // Rx(90) takes z to -y, which becomes -z.
  EXPECT_LT((p.col(2) - Eigen::Vector3d(1, 2, 2)).norm(), 1e-12);
}

TEST(Bvh, PositionsReplaceTheOffset) {
  const Bvh bvh = Parse(R"(HIERARCHY
ROOT a { OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation
JOINT b { OFFSET 1 2 3 CHANNELS 2 Yposition Xrotation End Site { OFFSET 0 0 1 } } }
MOTION
Frames: 1
Frame Time: .0083333
0 0 0 7 0
)");
  EXPECT_EQ(bvh.rate, 120);
  EXPECT_LT((Places(bvh).col(1) - Eigen::Vector3d(1, 7, 3)).norm(), 1e-12);
}

TEST(Bvh, TheGroundTellsWhetherTheRootsOffsetIsAdded) {
  const auto low = [](const std::string& motion) {
    return Places(
        Parse("HIERARCHY\nROOT a { OFFSET 0 9 0 CHANNELS 3 Xposition Yposition Zposition "
              "JOINT b { OFFSET 0 -5 0 End Site { OFFSET 0 -4 0 } } }\nMOTION\n"
              "Frames: 1\nFrame Time: 0.01\n" +
              motion))(1, 2);
  };
  EXPECT_NEAR(low("0 9 0\n"), 0, 1e-12);
  EXPECT_NEAR(low("0 0 0\n"), 0, 1e-12);
}

TEST(Bvh, AWayAlongTheGroundTellsNothingOfTheRootsOffset) {
  const Bvh bvh = Parse(
      "HIERARCHY\nROOT a { OFFSET 1 9 -15 CHANNELS 3 Xposition Yposition Zposition "
      "JOINT b { OFFSET 0 -5 0 End Site { OFFSET 0 -4 0 } } }\nMOTION\n"
      "Frames: 2\nFrame Time: 0.01\n0 9 15\n0 9 16\n");
  EXPECT_FALSE(bvh.adds_root_offset);
}

TEST(Bvh, FramesMayBeBrokenIntoLines) {
  const Bvh bvh =
      ParseMotion("Frames: 2\nFrame Time: 0.04\n1 2 3\n0 0 0 0\n4 5 6\n0 0\n0 0\n7 8\n");
  ASSERT_EQ(bvh.num_frames(), 2);
  EXPECT_EQ(Places(bvh, 1)(1, 0), 5);
}

TEST(Bvh, FramesThatAreNoneAreNotKnown) {
  Warnings warnings;
  const Bvh bvh = ParseMotion(
      "Frames: 9\r\nFrame Time: 0.04\r\n1 2 3 0 0 0 0 \r\n\r\n1 2 x 0 0 0 0\r\n1 2 3\r\n"
      "nan 2 3 0 0 0 0\r\n1e300 2 3 0 0 0 0\r\n4 2 3 0 0 0 0",
      &warnings);
  ASSERT_EQ(bvh.num_frames(), 6);
  EXPECT_EQ(bvh.declared_frames, 9);
  for (const int k : {1, 2, 3, 4}) EXPECT_FALSE(Places(bvh, k).array().isFinite().any()) << k;
  EXPECT_EQ(Places(bvh, 5)(0, 0), 4);
  EXPECT_THAT(warnings.texts(),
              ::testing::Contains(HasSubstr("line 19: 3 numbers for 7 channels")));
  EXPECT_THAT(warnings.texts(), ::testing::Contains("Frames: says 9, there are 6"));
}

TEST(Bvh, RefusesWhatIsNoSkeletonWithItsLine) {
  const std::string head = kHead;
  EXPECT_THAT(Refusal("HIERARCHY\n"), HasSubstr("input:2: the file ends; expected ROOT"));
  EXPECT_THAT(Refusal("HIERARCHY\nROOT a\n{\nOFFSET 0 0\n}"), HasSubstr("input:5: \"}\""));
  EXPECT_THAT(Refusal("HIERARCHY\nROOT a {\nOFFSET 0 0 nan\n}"), HasSubstr("three numbers"));
  EXPECT_THAT(Refusal("HIERARCHY\nROOT a {\nCHANNELS 1 Wrotation\n}"), HasSubstr("Wrotation"));
  EXPECT_THAT(Refusal("HIERARCHY\nROOT a {\nCHANNELS 99999 Xrotation\n}"), HasSubstr("0 to 9"));
  EXPECT_THAT(Refusal("HIERARCHY\nROOT a {\n} }"), HasSubstr("input:3"));
  EXPECT_THAT(Refusal("HIERARCHY\nROOT a { End Site { JOINT b { } } }"), HasSubstr("can't be"));
  EXPECT_THAT(Refusal(head), HasSubstr("Frames"));
  EXPECT_THAT(Refusal(head + "Frames: 1\nFrame Time: 0.01\n"), HasSubstr("no whole frame"));
  EXPECT_THAT(Refusal(head + "Frames: 1\nFrame Time: 0.01\n1 2 3"), HasSubstr("no whole frame"));
  std::string deep = "HIERARCHY\nROOT a {";
  for (int i = 0; i < 20'000; ++i) deep += "JOINT b {";
  EXPECT_THAT(Refusal(deep), HasSubstr("more than 10000 joints"));
  std::string many = "HIERARCHY\nROOT a { CHANNELS 1 Xrotation ";
  for (int i = 0; i < 100; ++i) many += "JOINT b { }";
  EXPECT_THAT(Refusal(many + "}\nMOTION\nFrames: 1\nFrame Time: 1\n0"), HasSubstr("no motion"));
}

TEST(Bvh, NoCutMakesItCrash) {
  const std::string whole = std::string(kHead) + "Frames: 1\nFrame Time: 0.01\n1 2 3 90 90 0 90\n";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try {
      Parse(whole.substr(0, length));
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("input"));
    }
  }
}

}  // namespace
}  // namespace mmm_converter
