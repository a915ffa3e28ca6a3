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
  const std::string bytes = FormatMvnPacket(0x01020304, 0x0A0B0C0D, poses);
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

// Indices from 0.
constexpr int kPelvis = 0, kHead = 6, kRightUpperArm = 8, kLeftUpperArm = 12, kLeftHand = 14,
              kRightUpperLeg = 15, kLeftUpperLeg = 19;

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
