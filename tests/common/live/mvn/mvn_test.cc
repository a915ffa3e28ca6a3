// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "common/live/mvn/mvn_body.h"
#include "common/live/mvn/mvn_packet.h"
#include "common/support/error.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::uint32_t LongAt(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

float FloatAt(const std::string& bytes, std::size_t at) {
  return std::bit_cast<float>(LongAt(bytes, at));
}

TEST(MvnPacket, EveryByte) {
  MvnPoses poses;
  for (auto& pose : poses) pose.setIdentity();
  poses[22].translation() << 1.5, -2, 0.25;
  poses[22].linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  const std::string bytes = FormatMvnPoses({0x01020304, 0x0A0B0C0D}, poses);
  ASSERT_EQ(bytes.size(), 760U);
  EXPECT_EQ(bytes.substr(0, 6), "MXTP02");
  EXPECT_EQ(LongAt(bytes, 6), 0x01020304U);
  EXPECT_EQ(LongAt(bytes, 10), 0x80170A0BU);
  EXPECT_EQ(LongAt(bytes, 14), 0x0C0D0017U);
  EXPECT_EQ(LongAt(bytes, 18), 0U);
  EXPECT_EQ(LongAt(bytes, 20), 736U);
  const std::size_t last = 24 + 22 * 32;
  EXPECT_EQ(LongAt(bytes, last), 23U);
  EXPECT_EQ(FloatAt(bytes, last + 4), 1.5F);
  EXPECT_EQ(FloatAt(bytes, last + 8), -2.0F);
  EXPECT_EQ(FloatAt(bytes, last + 12), 0.25F);
  EXPECT_NEAR(FloatAt(bytes, last + 16), std::sqrt(0.5), 1e-7);
  EXPECT_NEAR(FloatAt(bytes, last + 28), std::sqrt(0.5), 1e-7);
}

std::string PayloadOf(const std::string& bytes, const std::string& kind, std::uint8_t items) {
  EXPECT_EQ(bytes.substr(0, 6), "MXTP" + kind);
  EXPECT_EQ(static_cast<std::uint8_t>(bytes[11]), items);
  EXPECT_EQ(LongAt(bytes, 20), bytes.size() - 24);
  return bytes.substr(24);
}

TEST(MvnPacket, NameSizeAnglesAndTime) {
  EXPECT_EQ(PayloadOf(FormatMvnName({}, "an\nna"), "12", 1), "name:an na\n");
  EXPECT_EQ(PayloadOf(FormatMvnTimeCode({0, 3723004}), "25", 1), "01:02:03.004");
  const KinematicModel model = testing::ScaledReferenceModel(1.8);
  const MvnBody body(model);
  const MvnPoses t_pose = body.TPose(model);
  const std::string scale = PayloadOf(FormatMvnScale({}, t_pose), "13", 23);
  EXPECT_EQ(LongAt(scale, 0), 23U);
  EXPECT_EQ(scale.substr(4, 10), std::string("\0\0\0\6Pelvis", 10));
  EXPECT_EQ(FloatAt(scale, 14), 0.0F);  // x
  EXPECT_EQ(LongAt(scale, scale.size() - 4), 0U);
  // The left hand is to the left, as high as the shoulder; somebody stands on the ground.
  EXPECT_GT(t_pose[14].translation().y(), 0.6);
  EXPECT_NEAR(t_pose[14].translation().z(), t_pose[12].translation().z(), 1e-9);
  EXPECT_NEAR(t_pose[22].translation().z(), 0, 0.03);
  // A knee that is bent by 30 degrees, and the hip behind it.
  Posture posture = ZeroPosture(model);
  posture.joint_angles[model.FindJoint("RKx_joint")] = -M_PI / 6;
  const std::string angles =
      PayloadOf(FormatMvnJointAngles({}, body.Poses(model, posture)), "20", 22);
  ASSERT_EQ(angles.size(), 22U * 20);
  const std::size_t knee = 15 * 20;
  EXPECT_EQ(LongAt(angles, knee), 16U << 8);
  EXPECT_EQ(LongAt(angles, knee + 4), 17U << 8);
  EXPECT_NEAR(FloatAt(angles, knee + 8), 0, 1e-5);
  EXPECT_NEAR(FloatAt(angles, knee + 12), 30, 1e-4);
  EXPECT_NEAR(FloatAt(angles, knee + 16), 0, 1e-5);
  // The T-pose is where all of them are zero.
  const std::string none = FormatMvnJointAngles({}, t_pose);
  for (std::size_t at = 24; at < none.size(); at += 20)
    EXPECT_NEAR(FloatAt(none, at + 12), 0, 1e-5);
}

// Indices from 0.
constexpr int kPelvis = 0, kHead = 6, kRightUpperArm = 8, kLeftUpperArm = 12, kRightUpperLeg = 15,
              kLeftUpperLeg = 19;

TEST(MvnBody, AxesAreForwardLeftUpWhereSomebodyStands) {
  const KinematicModel model = testing::ScaledReferenceModel(1.8);
  const MvnPoses poses = MvnBody(model).Poses(model, ZeroPosture(model));
  // MMM's zero posture looks along y, its left is -x.
  Matrix3d forward_left_up;
  forward_left_up << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for (const int i : {kPelvis, kHead, kRightUpperLeg, kLeftUpperLeg}) {
    EXPECT_TRUE(poses[static_cast<std::size_t>(i)].linear().isApprox(forward_left_up, 1e-9)) << i;
  }
  EXPECT_LT(poses[kLeftUpperLeg].translation().x(), poses[kRightUpperLeg].translation().x());
  EXPECT_GT(poses[kHead].translation().z(), poses[kPelvis].translation().z());
}

// In MVN's T-pose all segments' axes are the person's: raised to the side, arms have them.
TEST(MvnBody, RaisedArmsHaveTheAxesOfTheBody) {
  const KinematicModel model = testing::ScaledReferenceModel(1.8);
  for (const bool is_left : {true, false}) {
    Posture posture = ZeroPosture(model);
    const int joint = model.FindJoint(is_left ? "LSy_joint" : "RSy_joint");
    ASSERT_GE(joint, 0);
    posture.joint_angles[joint] = is_left ? M_PI / 2 : -M_PI / 2;
    const MvnPoses poses = MvnBody(model).Poses(model, posture);
    const auto& arm = poses[static_cast<std::size_t>(is_left ? kLeftUpperArm : kRightUpperArm)];
    const auto& forearm =
        poses[static_cast<std::size_t>(is_left ? kLeftUpperArm : kRightUpperArm) + 1];
    const Vector3d along = arm.linear().transpose() * (forearm.translation() - arm.translation());
    EXPECT_GT(is_left ? along.y() : -along.y(), 0.99 * along.norm());
    EXPECT_NEAR(std::abs(forearm.translation().z() - arm.translation().z()), 0, 1e-9);
    EXPECT_TRUE(arm.linear().isApprox(poses[kPelvis].linear(), 1e-9)) << is_left;
  }
}

TEST(MvnBody, AModelOfNobody) { EXPECT_THROW(MvnBody{testing::MakeBranchedModel()}, Error); }

}  // namespace
}  // namespace mmm_converter
