// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_model_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/io/mmm/mmm_model.h"
#include "common/io/urdf/urdf_model_reader.h"
#include "common/math/seeded_random.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::SourcePath;

// Positions of a person are read back to 1e-9 m: rotations are written as angles of 16 digits.
constexpr double kNanometre = 1e-9;

std::string WithoutBlanks(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Reads the URDF of a model back: everything but the angles' last digits is the same.
void ExpectReadBack(const KinematicModel& model) {
  const UrdfModel read = ParseUrdfModel(FormatUrdf(model, "a test").xml, "own.urdf");
  const KinematicModel& back = read.model;
  ASSERT_EQ(back.segments().size(), model.segments().size());
  ASSERT_EQ(back.num_joints(), model.num_joints());
  ASSERT_EQ(back.markers().size(), model.markers().size());
  for (std::size_t i = 0; i < model.segments().size(); ++i) {
    const Segment& was = model.segments()[i];
    const Segment& is = back.segments()[i];
    SCOPED_TRACE(was.name);
    EXPECT_EQ(is.name, WithoutBlanks(was.name));
    EXPECT_EQ(is.parent, was.parent);
    EXPECT_EQ(is.joint, was.joint);
    EXPECT_EQ(is.mass, was.mass);
    if (was.joint >= 0) {
      EXPECT_EQ(is.lower, was.lower);
      EXPECT_EQ(is.upper, was.upper);
    }
    if (was.mass > 0) {
      EXPECT_EQ(is.p_SB, was.p_SB);
      EXPECT_EQ(is.inertia, was.inertia);
    }
  }
  SeededRandom random(1);
  for (int run = 0; run < 20; ++run) {
    const Posture posture = testing::RandomPosture(model, random);
    const auto X_was = SegmentPoses(model, posture);
    const auto X_is = SegmentPoses(back, posture);
    for (std::size_t i = 0; i < X_was.size(); ++i) {
      EXPECT_LT((X_is[i].matrix() - X_was[i].matrix()).cwiseAbs().maxCoeff(), kNanometre);
    }
    const Eigen::Matrix3Xd p_was = MarkerPositions(model, posture);
    const Eigen::Matrix3Xd p_is = MarkerPositions(back, posture);
    for (std::size_t i = 0; i < model.markers().size(); ++i) {
      const int other = back.FindMarker(model.markers()[i].name);
      ASSERT_GE(other, 0) << model.markers()[i].name;
      EXPECT_LT((p_is.col(other) - p_was.col(static_cast<Eigen::Index>(i))).norm(), kNanometre);
    }
  }
}

TEST(UrdfWriter, ShippedModelOfAPersonIsReadBackTheSame) {
  const KinematicModel model =
      ScaleWinter(ReadMmmModel(SourcePath("xml_config/models/mmm.xml")), {1.75, 70, std::nullopt});
  EXPECT_THAT(FormatUrdf(model, "").renamed,
              HasSubstr("underscores were needed: \"Hand L Root\" as Hand_L_Root, "));
  ExpectReadBack(model);
}

TEST(UrdfWriterRealFiles, RealModelsAreReadBackTheSame) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file : {"mmm/models/mmm_2014_82nodes_52markers.xml",
                           "mmm/models/mmm_v2.2_133nodes_53markers.xml"}) {
    SCOPED_TRACE(file);
    ExpectReadBack(ScaleWinter(ReadMmmModel(testing::SharedData(file)), {1.6, 55, std::nullopt}));
  }
}

TEST(UrdfWriter, RobotsAreReadBackTheSame) {
  ExpectReadBack(ReadUrdfModel(SourcePath("tests/support/humanoid.urdf")).model);
}

/// A root and nodes below it, each turned by one of the rotations.
KinematicModel Turned(const std::vector<Eigen::Matrix3d>& rotations) {
  ModelDescription description;
  description.name = "turned";
  description.segments.resize(1 + rotations.size());
  description.segments[0].name = "root";
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    Segment& segment = description.segments[i + 1];
    segment.name = "n" + std::to_string(i);
    segment.parent = 0;
    segment.type = JointType::kRevolute;
    segment.upper = 1;
    segment.X_PF.linear() = rotations[i];
    segment.X_PF.translation().setConstant(0.1);
    description.markers.push_back(
        {"m" + std::to_string(i), static_cast<int>(i) + 1, Eigen::Vector3d::Constant(0.5)});
  }
  return KinematicModel(std::move(description));
}

TEST(UrdfWriter, RotationsNearGimbalLockKeepTheirDigits) {
  std::vector<Eigen::Matrix3d> rotations;
  for (const double from_lock : {0.0, 1e-16, 1e-12, 1e-9, 3e-9, 1e-8, 1e-6, 1e-3}) {
    for (const double sign : {-1.0, 1.0}) {
      rotations.push_back(
          (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(sign * (EIGEN_PI / 2 - from_lock), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(-1.1, Eigen::Vector3d::UnitX()))
              .toRotationMatrix());
    }
  }
  ExpectReadBack(Turned(rotations));
}

TEST(UrdfWriter, WhatAUrdfCanNotHoldIsSaid) {
  ModelDescription description;
  description.name = "a \"model\" <x>";
  description.segments.resize(4);
  const char* const names[] = {"b_link", "b", "left arm", "left/arm"};
  for (int i = 0; i < 4; ++i) {
    description.segments[i].name = names[i];
    description.segments[i].parent = i - 1;
    description.segments[i].mass = i > 1 ? 1 : 0;
    description.segments[i].inertia.setIdentity();
  }
  description.segments[0].inertia.setZero();
  description.segments[3].inertia.diagonal() << 1, 1, 3;
  description.markers = {{"C 7", 3, Eigen::Vector3d::Zero()}};
  const KinematicModel model(std::move(description));
  Warnings warnings;
  const UrdfText urdf = FormatUrdf(model, "-- with -- hyphens --", &warnings);
  EXPECT_THAT(warnings.texts(),
              ElementsAre(HasSubstr("model node 'b': has no mass; its inertia is left out"),
                          HasSubstr("model node 'left/arm': no body of 1 kg has its inertia")));
  EXPECT_THAT(urdf.renamed, HasSubstr("\"b_link\" as b_link_, \"left arm\" as left_arm, "
                                      "\"left/arm\" as left_arm_, \"C 7_marker\" as C_7_marker"));
  const UrdfModel read = ParseUrdfModel(urdf.xml, "own.urdf");
  EXPECT_EQ(read.model.name(), "a__model___x_");
  EXPECT_EQ(read.model.segments()[3].name, "left_arm_");
  EXPECT_EQ(read.model.segments()[3].inertia(2, 2), 3);
  EXPECT_EQ(read.model.markers()[0].name, "C_7");
}

}  // namespace
}  // namespace mmm_converter
