// SPDX-License-Identifier: MIT
#include "common/io/tables/bvh_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "common/io/mmm/mmm_model.h"
#include "common/math/up_axis.h"
#include "common/model/forward_kinematics.h"
#include "common/model/kit_joints.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/error.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/stick_model.h"
#include "tests/support/strict_bvh.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using testing::ReadStrictBvh;
using testing::StrictBvh;

// Six decimals of a centimetre and of a degree, ten rotations on less than 2 m [m].
constexpr double kBvhRounding = 1e-6;

PoseTrajectory RandomMotion(const KinematicModel& model, int frames) {
  SeededRandom random(3);
  PoseTrajectory motion;
  motion.rate = 100;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  for (int k = 0; k < frames; ++k) motion.postures.push_back(testing::RandomPosture(model, random));
  return motion;
}

void ExpectPlaces(const StrictBvh& bvh, const KinematicModel& model, const PoseTrajectory& motion,
                  const std::map<std::string, std::string>& segment_of_joint) {
  const Eigen::Matrix3d to_z_up = RotationToZUp(UpAxis::kY);
  for (int k = 0; k < motion.num_frames(); ++k) {
    const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
    const auto places = bvh.Places(k);
    for (const auto& [joint, segment] : segment_of_joint) {
      ASSERT_GE(bvh.Find(joint), 0) << joint;
      const Eigen::Vector3d place = 0.01 * to_z_up * places[bvh.Find(joint)];
      ASSERT_LT((place - X_WS[model.FindSegment(segment)].translation()).norm(), kBvhRounding)
          << joint << ", frame " << k;
    }
  }
}

TEST(BvhWriterTest, WritesEveryByteOfTheFormat) {
  const KinematicModel model = testing::StickModel();
  PoseTrajectory motion;
  motion.rate = 50;
  motion.joint_names = {"knee"};
  motion.postures.resize(2);
  motion.postures[0].position = {0.1, 0.2, 1};
  motion.postures[0].joint_angles = Eigen::VectorXd::Constant(1, 0.5);
  motion.postures[1] = motion.postures[0];
  motion.postures[1].joint_angles[0] = -0.5;
  EXPECT_EQ(Join(FormatBvh(model, motion)),
            "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 0 0\n"
            "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
            "\tJOINT knee\n\t{\n\t\tOFFSET 0 50 0\n"
            "\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
            "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 60 0\n\t\t}\n\t}\n}\n"
            "MOTION\nFrames: 2\nFrame Time: 0.02\n"
            "10 100 -20 0 0 0 0 28.64789 0\n10 100 -20 0 0 0 0 -28.64789 0\n");
}

TEST(BvhWriterTest, JointsAreWhereTheModelHasThem) {
  const KinematicModel model = testing::MakeBranchedModel();
  const PoseTrajectory motion = RandomMotion(model, 50);
  const StrictBvh bvh = ReadStrictBvh(Join(FormatBvh(model, motion)));
  ExpectPlaces(bvh, model, motion,
               {{"Hips", "root"},
                {"a_x", "a_x"},
                {"b_y", "b_y"},
                {"c_oblique", "c_oblique"},
                {"d_x", "d_x"}});
  EXPECT_EQ(bvh.joints.size(), 5u + 2u);  // three joints at one place are one
}

TEST(BvhWriterTest, MmmJointsHaveTheNamesOfCharacters) {
  const KinematicModel model = ScaleWinter(
      ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.75, 70, std::nullopt});
  PoseTrajectory motion = RandomMotion(model, 20);
  const StrictBvh all = ReadStrictBvh(Join(FormatBvh(model, motion)));
  EXPECT_GE(all.Find("LeftFingerJoint13"), -1);
  PoseTrajectory kit = motion;
  kit.joint_names = KitJointNames();
  for (int k = 0; k < kit.num_frames(); ++k) {
    Eigen::VectorXd angles(44);
    for (int j = 0; j < 44; ++j) {
      angles[j] = motion.postures[k].joint_angles[model.FindJoint(kit.joint_names[j])];
    }
    kit.postures[k].joint_angles = angles;
  }
  const StrictBvh bvh = ReadStrictBvh(Join(FormatBvh(model, kit)));
  std::map<std::string, std::string> expected = {
      {"Hips", "root_joint"}, {"Spine", "BPx_joint"}, {"Spine1", "BTx_joint"},
      {"Neck", "BLNx_joint"}, {"Head", "BUNx_joint"}, {"Head_end", "HeadSegment_joint"}};
  for (const char* side : {"Left", "Right"}) {
    const std::string s(1, side[0]);
    for (const auto& [name, segment] : std::map<std::string, std::string>{{"Shoulder", "SCx"},
                                                                          {"Arm", "Sx"},
                                                                          {"ForeArm", "Ex"},
                                                                          {"Hand", "Wx"},
                                                                          {"UpLeg", "Hx"},
                                                                          {"Leg", "Kx"},
                                                                          {"Foot", "Ax"},
                                                                          {"MidFoot", "Mrot"},
                                                                          {"ToeBase", "Fx"}}) {
      expected[side + name] = s + segment + "_joint";
    }
  }
  ExpectPlaces(bvh, model, kit, expected);
  EXPECT_EQ(bvh.joints.size(), 5u + 18u + 5u);  // five ends
}

TEST(BvhWriterTest, AnglesDoNotJump) {
  const KinematicModel model = testing::StickModel();
  PoseTrajectory motion;
  motion.rate = 100;
  motion.joint_names = {"knee"};
  for (int k = 0; k < 400; ++k) {
    Posture q;
    q.orientation = Eigen::AngleAxisd(0.05 * k, Eigen::Vector3d(0.3, -0.2, 1).normalized());
    q.joint_angles = Eigen::VectorXd::Zero(1);
    motion.postures.push_back(q);
  }
  const StrictBvh bvh = ReadStrictBvh(Join(FormatBvh(model, motion)));
  for (std::size_t k = 1; k < bvh.frames.size(); ++k) {
    for (std::size_t i = 3; i < bvh.frames[k].size(); ++i) {
      EXPECT_LT(std::abs(bvh.frames[k][i] - bvh.frames[k - 1][i]), 10);  // 2.9 degrees a frame
    }
  }
}

}  // namespace
}  // namespace mmm_converter
