// SPDX-License-Identifier: MIT
// Skeletons that are read as recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/io/tables/bvh_writer.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "tests/support/made_skeleton.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using testing::SkeletonStyle;

// Nine decimals of the file's unit and of a degree.
constexpr double kRounding = 1e-6;

const KinematicModel& Person() {
  static const KinematicModel person =
      ScaleWinter(ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.75, 70, {}});
  return person;
}

/// Each joint about its rest, so that the person stands.
PoseTrajectory Standing(int frames) {
  SeededRandom random(5);
  PoseTrajectory motion;
  motion.rate = 120;
  for (int j = 0; j < Person().num_joints(); ++j) {
    motion.joint_names.push_back(Person().joint(j).name);
  }
  for (int k = 0; k < frames; ++k) {
    Posture posture = testing::RandomPosture(Person(), random);
    posture.joint_angles *= 0.3;
    posture.position = Eigen::Vector3d(0.1 * k, 0.2, 0.95);
    posture.orientation = Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d::UnitZ());
    motion.postures.push_back(posture);
  }
  return motion;
}

std::string FileOf(const std::string& text) {
  const std::string file = testing::TestFolder() + "/walk.bvh";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void ExpectPlaces(const testing::MadeSkeleton& made, const Recording& recording) {
  ASSERT_EQ(recording.markers.num_frames(), static_cast<int>(made.places.size()));
  for (std::size_t j = 0; j < made.names.size(); ++j) {
    const int label = recording.markers.FindLabel(made.names[j]);
    ASSERT_GE(label, 0) << made.names[j];
    for (int k = 0; k < recording.markers.num_frames(); ++k) {
      const Eigen::Vector3d truth =
          made.places[static_cast<std::size_t>(k)].col(static_cast<Eigen::Index>(j));
      ASSERT_LT((recording.markers.frame(k).col(label) - truth).norm(), kRounding)
          << made.names[j] << " in frame " << k;
    }
  }
}

std::string BodyOf(const Recording& recording, BodyJoint joint, const std::string& side) {
  for (const SkeletonJoint& one : recording.body) {
    if (one.joint != joint || one.side != side) continue;
    return recording.markers.labels()[static_cast<std::size_t>(one.label)];
  }
  return "none";
}

class MadeSkeletons
    : public ::testing::TestWithParam<std::tuple<const char*, SkeletonStyle::Zero>> {};

TEST_P(MadeSkeletons, AreWhereTheirJointsAre) {
  SkeletonStyle style;
  style.order = std::get<0>(GetParam());
  style.zero = std::get<1>(GetParam());
  const PoseTrajectory motion = Standing(12);
  for (const auto names :
       {SkeletonStyle::Names::kLafan, SkeletonStyle::Names::kXsens, SkeletonStyle::Names::kSmpl}) {
    for (const bool is_metre : {false, true}) {
      style.names = names;
      style.unit = is_metre ? 1 : 0.01;
      style.has_y_up = is_metre;
      style.moves_bones = is_metre;
      const testing::MadeSkeleton made = testing::MakeSkeleton(Person(), motion, style);
      Warnings warnings;
      const Recording recording = ReadRecording(FileOf(made.bvh), {}, &warnings);
      EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
      EXPECT_EQ(recording.unit, is_metre ? "m" : "cm");
      EXPECT_EQ(recording.up_axis, is_metre ? UpAxis::kY : UpAxis::kZ);
      EXPECT_EQ(recording.markers.rate(), 120);
      ExpectPlaces(made, recording);
      const auto n = static_cast<std::size_t>(names);
      const char* const kHips[] = {"LeftUpLeg", "LeftHip", "L_Hip"};
      const char* const kShoulders[] = {"RightArm", "RightShoulder", "R_Shoulder"};
      const char* const kToes[] = {"LeftToe", "LeftToe", "L_Foot"};
      EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), kHips[n]);
      EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "R"), kShoulders[n]);
      EXPECT_EQ(BodyOf(recording, BodyJoint::kToe, "L"), kToes[n]);
      const char* const kThoraxes[] = {"Spine1", "Chest2", "Spine2"};
      EXPECT_EQ(BodyOf(recording, BodyJoint::kThorax, ""), kThoraxes[n]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Orders, MadeSkeletons,
    ::testing::Combine(::testing::Values("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"),
                       ::testing::Values(SkeletonStyle::Zero::kT, SkeletonStyle::Zero::kA,
                                         SkeletonStyle::Zero::kAllAlongX)));

TEST(SkeletonContent, WhatWasExportedIsReadBack) {
  const PoseTrajectory motion = Standing(5);
  for (const BvhUnit unit : {BvhUnit::kCentimetres, BvhUnit::kMetres}) {
    Warnings warnings;
    const Recording recording =
        ReadRecording(FileOf(Join(FormatBvh(Person(), motion, unit))), {}, &warnings);
    EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
    for (const auto& [joint, segment] :
         {std::pair("Hips", ""), std::pair("LeftUpLeg", "LHsegment_joint"),
          std::pair("LeftLeg", "LKsegment_joint"), std::pair("RightFoot", "RAsegment_joint"),
          std::pair("RightArm", "RSsegment_joint"), std::pair("RightHand", "RWsegment_joint")}) {
      const int label = recording.markers.FindLabel(joint);
      ASSERT_GE(label, 0) << joint;
      const int index = *segment == '\0' ? 0 : Person().FindSegment(segment);
      for (int k = 0; k < motion.num_frames(); ++k) {
        const auto X_WS = SegmentPoses(Person(), ModelPosture(Person(), motion, k));
        EXPECT_LT((recording.markers.frame(k).col(label) -
                   X_WS[static_cast<std::size_t>(index)].translation())
                      .norm(),
                  kRounding)
            << joint;
      }
    }
  }
}

TEST(SkeletonContent, SidesThatAreNamedTheOtherWayRoundAreExchanged) {
  std::string bvh = testing::MakeSkeleton(Person(), Standing(20), {}).bvh;
  const auto replace = [&](const std::string& what, const std::string& by) {
    for (auto at = bvh.find(what); at != std::string::npos; at = bvh.find(what, at + by.size())) {
      bvh.replace(at, what.size(), by);
    }
  };
  replace("Left", "Middle");
  replace("Right", "Left");
  replace("Middle", "Right");
  Warnings warnings;
  const Recording recording = ReadRecording(FileOf(bvh), {}, &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::ElementsAre(::testing::HasSubstr("so they are taken")));
  EXPECT_EQ(BodyOf(recording, BodyJoint::kKnee, "L"), "RightLeg");
}

TEST(SkeletonContent, WhatIsNoBodyIsMarkers) {
  Warnings warnings;
  const Recording recording = ReadRecording(
      FileOf("HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 3 Xposition Yposition Zposition JOINT tail "
             "{ OFFSET 0 1 0 End Site { OFFSET 0 0 1 } } }\nMOTION\nFrames: 2\nFrame Time: 0.01\n"
             "0 0 0\n1 0 0\n"),
      {}, &warnings);
  EXPECT_THAT(recording.markers.labels(), ::testing::ElementsAre("a", "tail", "tail.end"));
  EXPECT_TRUE(recording.body.empty());
  EXPECT_THAT(warnings.texts(), ::testing::Contains(::testing::HasSubstr("no two legs")));
}

TEST(RealSkeletons, HaveTheirUnitAxisAndJoints) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const struct {
    const char* file;
    const char* unit;
    UpAxis up;
    double rate;
    const char* hip;
    const char* shoulder;
  } kFiles[] = {
      {"assimp__01_01", "in / 0.45", UpAxis::kY, 120, "LeftUpLeg", "LeftArm"},
      {"bvh-python__test_mocapbank", "cm", UpAxis::kY, 30, "LeftHip", "LeftShoulder"},
      {"bvh-toolbox__walk01", "cm", UpAxis::kY, 24, "LeftUpLeg", "LeftArm"},
      {"fairmotion__pfnn_hierarchy", "m", UpAxis::kY, 30, "LeftUpLeg", "LeftArm"},
      {"pybvh__bvh_example", "in", UpAxis::kZ, 30, "LeftUpLeg", "LeftArm"},
      {"video2bvh__cxk", "mm", UpAxis::kZ, 30, "LeftUpLeg", "LeftArm"},
  };
  for (const auto& file : kFiles) {
    const Recording recording =
        ReadRecording(testing::SharedData("motions/" + std::string(file.file) + ".bvh"), {});
    EXPECT_EQ(recording.unit, file.unit) << file.file;
    EXPECT_EQ(recording.up_axis, file.up) << file.file;
    EXPECT_NEAR(recording.markers.rate(), file.rate, 0.05) << file.file;
    EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), file.hip) << file.file;
    EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "L"), file.shoulder) << file.file;
  }
}

}  // namespace
}  // namespace mmm_converter
