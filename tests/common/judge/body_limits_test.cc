// SPDX-License-Identifier: MIT
#include "common/judge/body_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/convert/marker_mapping.h"
#include "common/convert/marker_set.h"
#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class BodyLimitsTest : public ::testing::Test {
 protected:
  BodyLimitsTest() {
    const KinematicModel reference = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
    setup_.model = std::make_shared<const KinematicModel>(ScaleWinter(reference, {1.7, 70, {}}));
    for (int j = 0; j < reference.num_joints(); ++j) setup_.joints.push_back(j);
    for (int m = 0; m < static_cast<int>(reference.markers().size()); ++m) {
      setup_.mapping.assignments.push_back({LabelIx(m), MarkerIx(m), 1});
    }
    Fly();
  }

  /// Of a motion in which a joint has an angle in some of 100 frames.
  std::vector<std::string> Judge(const std::string& joint, double angle, int frames) const {
    PoseTrajectory trajectory;
    trajectory.rate = 100;
    for (const int j : setup_.joints) trajectory.joint_names.push_back(setup_.model->joint(j).name);
    Posture posture = ZeroPosture(*setup_.model);
    for (int k = 0; k < 100; ++k) {
      posture.joint_angles[setup_.model->FindJoint(joint)] = k < frames ? angle : 0.01;
      trajectory.postures.push_back(posture);
    }
    VerdictReasons reasons;
    JudgeBodyLimits(MeasureBodyLimits(setup_, recording_, trajectory), false, &reasons);
    return reasons.Conclude().reasons;
  }

  /// Markers that go up, so that no foot lies flat.
  void Fly() {
    Stand();
    for (int k = 0; k < 100; ++k) recording_.frame(k).row(2).array() += 0.05 * k;
  }

  /// Markers that stand still.
  void Stand() {
    std::vector<std::string> labels;
    for (const ModelMarker& marker : setup_.model->markers()) labels.push_back(marker.name);
    recording_ = MarkerSequence(labels, 100, 100, 0);
    const Eigen::Matrix3Xd p = MarkerPositions(*setup_.model, ZeroPosture(*setup_.model));
    for (int k = 0; k < 100; ++k) recording_.frame(k) = p;
  }

  MarkerSequence recording_;
  TrackingSetup setup_;
};

TEST_F(BodyLimitsTest, AJointAtItsLimitIsNamed) {
  EXPECT_THAT(
      Judge("LAy_joint", 0.349, 10),
      ElementsAre(AllOf(HasSubstr("joints stand at their limits"), HasSubstr("LAy_joint (10 %)"))));
  EXPECT_THAT(Judge("LAy_joint", 0.349, 4), IsEmpty());
  EXPECT_THAT(Judge("LAy_joint", 0.3, 50), IsEmpty());
}

TEST_F(BodyLimitsTest, FramesThatShowNobodyDoNotCount) {
  for (int k = 40; k < 100; ++k) recording_.frame(k).setConstant(NAN);
  EXPECT_THAT(Judge("LAy_joint", 0.349, 4), ElementsAre(HasSubstr("LAy_joint (10 %)")));
}

TEST_F(BodyLimitsTest, AStraightKneeStands) { EXPECT_THAT(Judge("LKx_joint", 0, 100), IsEmpty()); }

TEST_F(BodyLimitsTest, AKneeThatBendsBackwardsIsNamed) {
  Posture back = ZeroPosture(*setup_.model);
  back.joint_angles[setup_.model->FindJoint("LKx_joint")] = 0.2;  // beyond its limit
  const Eigen::Matrix3Xd p = MarkerPositions(*setup_.model, back);
  for (int k = 0; k < 100; ++k) recording_.frame(k) = p;
  EXPECT_THAT(Judge("LKx_joint", 0, 100),
              Contains(HasSubstr("LKx_joint (100 %, bent backwards by 11 degrees)")));
}

TEST_F(BodyLimitsTest, WhatOneMarkerAloneShowsCanNotTell) {
  std::erase_if(setup_.mapping.assignments, [&](const MarkerAssignment& one) {
    const std::string& name = setup_.model->markers()[one.marker].name;
    return name == "MARKER_LMT1" || name == "MARKER_LMT5";
  });
  EXPECT_THAT(Judge("LMrot_joint", 0.2617, 100), IsEmpty());
}

TEST_F(BodyLimitsTest, AnAnkleAboveItsHipIsNamed) {
  const std::vector<std::string> reasons = Judge("LHx_joint", 1.64, 60);
  EXPECT_THAT(reasons, Contains(HasSubstr("the left ankle is above its hip in 60 %")));
}

TEST_F(BodyLimitsTest, ASoleThatSlopesOnFlatGroundIsNamed) {
  Stand();
  EXPECT_THAT(Judge("LAx_joint", 0.3, 100),
              ElementsAre(HasSubstr("the left foot's sole slopes by 17 degrees")));
  EXPECT_THAT(Judge("LAx_joint", 0.2, 100), IsEmpty());
  EXPECT_THAT(Judge("LAx_joint", 0.3, 40), IsEmpty());
}

}  // namespace
}  // namespace mmm_converter
