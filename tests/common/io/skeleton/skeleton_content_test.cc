// SPDX-License-Identifier: MIT
// Skeletons that are read as recordings.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/io/tables/bvh_writer.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"
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
  std::string file = testing::TestFolder() + "/walk.bvh";
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

TEST(SkeletonContent, APelvisThatNeverMovesIsDoubted) {
  PoseTrajectory motion = Standing(12);
  for (Posture& posture : motion.postures) posture.position = {0.1, 0.2, 0.95};
  for (const double moves : {0.0, 0.005}) {
    motion.postures[6].position.z() = 0.95 + moves;
    const testing::MadeSkeleton made = testing::MakeSkeleton(Person(), motion, {});
    Warnings warnings;
    const Recording recording = ReadRecording(FileOf(made.bvh), {}, &warnings);
    ASSERT_EQ(recording.doubts.size(), moves > 0 ? 0U : 1U);
    if (moves > 0) continue;
    EXPECT_THAT(recording.doubts[0].text, ::testing::HasSubstr("the pelvis never moves"));
    EXPECT_THAT(warnings.texts(), ::testing::ElementsAre(recording.doubts[0].text));
  }
}

TEST(SkeletonContent, WhoLiesOnTheGroundTellsUpByIt) {
  PoseTrajectory motion = Standing(12);
  for (Posture& posture : motion.postures) {
    posture.joint_angles *= 0.1;
    posture.position.z() = 0.15;
    posture.orientation = Eigen::AngleAxisd(0.5 * EIGEN_PI, Eigen::Vector3d::UnitX());
  }
  for (const bool has_y_up : {true, false}) {
    SkeletonStyle style;
    style.has_y_up = has_y_up;
    Warnings warnings;
    const Recording recording =
        ReadRecording(FileOf(testing::MakeSkeleton(Person(), motion, style).bvh), {}, &warnings);
    EXPECT_EQ(recording.up_axis, has_y_up ? UpAxis::kY : UpAxis::kZ);
    EXPECT_FALSE(recording.doubts.empty());
  }
}

/// Everyone stands on the ground.
PoseTrajectory OnTheGround(PoseTrajectory motion) {
  for (int k = 0; k < motion.num_frames(); ++k) {
    double lowest = INFINITY;
    const auto X_WS = SegmentPoses(Person(), ModelPosture(Person(), motion, k));
    for (const char* name : {"LAsegment_joint", "RAsegment_joint", "LMrot_joint", "RMrot_joint"}) {
      const auto segment = static_cast<std::size_t>(Person().FindSegment(name));
      lowest = std::min(lowest, X_WS[segment].translation().z());
    }
    motion.postures[static_cast<std::size_t>(k)].position.z() -= lowest;
  }
  return motion;
}

/// The words of each line of a motion, behind its frame time.
std::vector<std::string> MotionLines(const std::string& bvh) {
  std::vector<std::string> lines;
  std::istringstream text(bvh.substr(bvh.find('\n', bvh.find("Frame Time")) + 1));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(SkeletonContent, PositionsInAnotherUnitThanBonesAreDoubted) {
  const testing::MadeSkeleton made = testing::MakeSkeleton(Person(), OnTheGround(Standing(12)), {});
  const std::vector<std::string> lines = MotionLines(made.bvh);
  for (const double scale : {1.0, 0.01, 100.0}) {
    std::string bvh = made.bvh.substr(0, made.bvh.find(lines.front()));
    for (const std::string& line : lines) {
      std::istringstream words(line);
      for (int a = 0; a < 3; ++a) {
        double position = 0;
        words >> position;
        bvh += fmt::format("{:.9f} ", scale * position);
      }
      std::string rest;
      std::getline(words, rest);
      bvh += rest + '\n';
    }
    const Recording recording = ReadRecording(FileOf(bvh), {});
    const bool is_doubted =
        std::any_of(recording.doubts.begin(), recording.doubts.end(), [](const auto& doubt) {
          return doubt.text.find("in another unit than the bones") != std::string::npos;
        });
    EXPECT_EQ(is_doubted, scale != 1) << scale;
  }
}

/// Two skeletons in a file.
std::string Both(const std::string& one, const std::string& other) {
  const std::size_t motion = one.find("MOTION"), begin = one.find("ROOT");
  const std::vector<std::string> left = MotionLines(one), right = MotionLines(other);
  std::string both = one.substr(0, motion) + other.substr(begin, other.find("MOTION") - begin) +
                     one.substr(motion, one.find(left.front()) - motion);
  for (std::size_t k = 0; k < left.size(); ++k) both += left[k] + " " + right[k] + '\n';
  return both;
}

TEST(SkeletonContent, OfSeveralPersonsOneIsChosen) {
  const PoseTrajectory motion = Standing(5);
  PoseTrajectory far = motion;
  for (Posture& posture : far.postures) posture.position.x() += 3;
  const testing::MadeSkeleton one = testing::MakeSkeleton(Person(), motion, {});
  const testing::MadeSkeleton other = testing::MakeSkeleton(Person(), far, {});
  const std::string file = FileOf(Both(one.bvh, other.bvh));
  const auto message = [](const char* text) {
    return ::testing::ThrowsMessage<Error>(::testing::HasSubstr(text));
  };
  EXPECT_THAT([&] { ReadRecording(file, {}); }, message("there are several persons: 1, 2"));
  EXPECT_THAT([&] { ReadRecording(file, {.subject = "Bob"}); }, message("there is no subject Bob"));
  for (const auto& [subject, made] : {std::pair("1", &one), std::pair("2", &other)}) {
    const Recording recording = ReadRecording(file, {.subject = subject});
    EXPECT_EQ(recording.subject, subject);
    ExpectPlaces(*made, recording);
  }
  // A thing beside a person is none.
  const std::string ball =
      "HIERARCHY\nROOT Ball\n{ OFFSET 0 0 0 CHANNELS 3 Xposition Yposition Zposition }\nMOTION\n"
      "Frames: 5\nFrame Time: 0.01\n0 0 0\n0 0 1\n0 0 2\n0 0 3\n0 0 4\n";
  ExpectPlaces(one, ReadRecording(FileOf(Both(one.bvh, ball)), {}));
}

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
  ASSERT_FALSE(recording.doubts.empty());
  EXPECT_THAT(recording.doubts.front().text, ::testing::HasSubstr("named left are right"));
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
  ASSERT_FALSE(recording.doubts.empty());
  EXPECT_THAT(recording.doubts.front().text, ::testing::HasSubstr("bones.xml"));
}

struct Bone {
  std::string name;  ///< $: the side
  Eigen::Vector3d offset;
};

std::string Chain(const std::vector<Bone>& bones, char side, const Eigen::Vector3d& end) {
  const double sign = side == 'l' ? 1 : -1;
  std::string text;
  const auto offset = [&](const Eigen::Vector3d& p) {
    text += fmt::format("{{ OFFSET {} {} {}\n", sign * p.x(), p.y(), p.z());
  };
  for (const Bone& bone : bones) {
    std::string name = bone.name;
    std::replace(name.begin(), name.end(), '$', side);
    text += "JOINT " + name + "\n";
    offset(bone.offset);
    text += "CHANNELS 3 Zrotation Xrotation Yrotation\n";
  }
  text += "End Site\n";
  offset(end);
  return text + "}" + std::string(bones.size(), '}') + "\n";
}

/// Of someone who stands, in a pose at rest.
Recording ReadRig(const std::string& root, const std::vector<Bone>& leg,
                  const Eigen::Vector3d& foot, const std::vector<Bone>& arm,
                  const Eigen::Vector3d& hand, Warnings* warnings) {
  std::string text =
      "HIERARCHY\nROOT " + root + "\n{ OFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n";
  for (const char side : {'l', 'r'}) text += Chain(leg, side, foot);
  text += "JOINT chest\n{ OFFSET 0 40 0\n";
  for (const char side : {'l', 'r'}) text += Chain(arm, side, hand);
  text +=
      "JOINT head\n{ OFFSET 0 25 0\nEnd Site { OFFSET 0 20 0 } } } }\nMOTION\nFrames: 2\nFrame "
      "Time: 0.01\n";
  const std::size_t turned = 2 * (leg.size() + arm.size());
  for (int k = 0; k < 2; ++k) {
    text += "0 90 0";
    for (std::size_t i = 0; i < 3 * turned; ++i) text += " 0";
    text += "\n";
  }
  return ReadRecording(FileOf(text), {}, warnings);
}

TEST(SkeletonContent, RootsMayBeNamedAsHips) {  // DAZ
  Warnings warnings;
  const Recording recording = ReadRig("hip",
                                      {{"$Buttock", {9, 4, 1}},
                                       {"$Thigh", {0, -2, -2}},
                                       {"$Shin", {0, -37, 1}},
                                       {"$Foot", {0, -45, -5}}},
                                      {0, -4, 12},
                                      {{"$Collar", {3, 1, 0}},
                                       {"$Shldr", {9, 0, 0}},
                                       {"$ForeArm", {28, 0, 0}},
                                       {"$Hand", {22, 0, 0}}},
                                      {10, 0, 0}, &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
  EXPECT_EQ(BodyOf(recording, BodyJoint::kPelvis, ""), "hip");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), "lThigh");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kKnee, "R"), "rShin");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "R"), "rShldr");
  EXPECT_EQ(recording.unit, "cm");
}

TEST(SkeletonContent, TwoArmsAloneAreAnUpperBody) {
  const std::vector<Bone> arm = {{"$Shoulder", {3, 20, 0}},
                                 {"$Arm", {15, 0, 0}},
                                 {"$ForeArm", {29, 0, 0}},
                                 {"$Hand", {26, 0, 0}}};
  Warnings warnings;
  const Recording recording = ReadRig("Hips", {}, {9, -6, 0}, arm, {10, 0, 0}, &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
  EXPECT_EQ(BodyOf(recording, BodyJoint::kPelvis, ""), "Hips");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kThorax, ""), "chest");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kElbow, "R"), "rForeArm");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), "none");
  EXPECT_EQ(recording.unit, "cm");
  EXPECT_EQ(recording.up_axis, UpAxis::kY);
  // Legs that no name tells are legs.
  EXPECT_TRUE(ReadRig("Hips", {{"a$", {9, -6, 0}}, {"b$", {0, -40, 0}}, {"c$", {0, -40, 0}}},
                      {0, -5, 0}, arm, {10, 0, 0}, &warnings)
                  .body.empty());
}

TEST(SkeletonContent, LimbsMayEndWithoutAName) {  // MoDi
  Warnings warnings;
  const Recording recording = ReadRig(
      "Hips", {{"Hips_$UpLeg", {0, 0, 0}}, {"$UpLeg", {.7, -.7, 0}}, {"$Leg", {0, -3.5, -.4}}},
      {0, -3.5, -.6},
      {{"$Shoulder", {.6, .7, 0}}, {"$Arm", {1.1, 0, 0}}, {"$ForeArm", {2.7, 0, 0}}}, {2.1, 0, 0},
      &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
  EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), "lUpLeg");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kAnkle, "L"), "lLeg.end");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "R"), "rArm");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kWrist, "R"), "rForeArm.end");
  EXPECT_EQ(recording.unit, "dm");
}

TEST(SkeletonContent, BonesThatAreNumberedAreThoseOfTheirLengths) {
  Warnings warnings;
  const Recording recording = ReadRig(
      "root",
      {{"$leg0", {.1, -.1, 0}},
       {"$leg1", {0, -.4, 0}},
       {"$leg2", {0, -.4, 0}},
       {"$leg3", {0, -.1, .1}}},
      {0, 0, .05}, {{"$arm0", {.05, .1, 0}}, {"$arm1", {.14, 0, 0}}, {"$arm2", {.12, 0, 0}}},
      {.1, 0, 0}, &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::IsEmpty());
  EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), "lleg0");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kAnkle, "L"), "lleg2");
  // The longest bones that are alike are an upper arm and a forearm, whatever is before them.
  EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "L"), "larm0");
  EXPECT_EQ(recording.unit, "m");
}

TEST(SkeletonContent, HalfAnUpperArmIsNone) {
  Warnings warnings;
  const Recording recording =
      ReadRig("root", {{"$hip", {10, -10, 0}}, {"$knee", {0, -40, 1}}, {"$ankle", {0, -40, -1}}},
              {0, 0, 15},
              {{"$clavicle", {3, 10, 0}},
               {"$shoulder", {14, 0, 0}},
               {"$arm", {13, 0, 0}},
               {"$elbow", {14, 0, 0}},
               {"$wrist", {25, 0, 0}}},
              {10, 0, 0}, &warnings);
  EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "L"), "lshoulder");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), "lhip");
}

TEST(SkeletonContent, WhereNamesTellNothingLengthsDo) {
  const std::vector<Bone> leg = {
      {"a$", {10, -10, 0}}, {"b$", {0, -40, 1}}, {"c$", {0, -40, -1}}, {"d$", {0, -8, 14}}};
  const auto read = [&](double arm, Warnings* warnings) {
    return ReadRig("joint0", leg, {0, 0, 5},
                   {{"e$", {5, 10, 0}}, {"f$", {14, 0, 0}}, {"g$", {arm, 0, 0}}}, {arm - 2, 0, 0},
                   warnings);
  };
  Warnings warnings;
  const Recording recording = read(27, &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::ElementsAre(::testing::HasSubstr("lengths")));
  EXPECT_EQ(BodyOf(recording, BodyJoint::kHip, "L"), "al");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kAnkle, "R"), "cr");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kToe, "R"), "dr");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kShoulder, "L"), "fl");
  EXPECT_EQ(BodyOf(recording, BodyJoint::kWrist, "R"), "gr.end");
  ASSERT_FALSE(recording.doubts.empty());
  EXPECT_THAT(recording.doubts.front().text, ::testing::HasSubstr("lengths of the bones"));
  // Four legs are no person's.
  EXPECT_TRUE(read(40, &warnings).body.empty());
}

TEST(SkeletonContent, LegsOfNoUsualLengthAreDoubted) {
  Warnings warnings;
  const Recording recording =
      ReadRig("root", {{"$hip", {1, -1, 0}}, {"$knee", {0, -5, 0}}, {"$ankle", {0, -5.1, 0}}},
              {0, 0, 1}, {{"$shoulder", {2, 0, 0}}, {"$elbow", {3, 0, 0}}, {"$wrist", {3, 0, 0}}},
              {1, 0, 0}, &warnings);
  EXPECT_THAT(warnings.texts(), ::testing::ElementsAre(::testing::HasSubstr("they have 1.01 m")));
  ASSERT_FALSE(recording.doubts.empty());
  EXPECT_THAT(recording.doubts.front().text, ::testing::HasSubstr("check the unit"));
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
