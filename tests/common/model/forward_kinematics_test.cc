// SPDX-License-Identifier: MIT
#include "common/model/forward_kinematics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"
#include "common/support/error.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Every expected number below is exact by hand; the tolerance is rounding of sums of about 1.
constexpr double kRounding = 1e-14;

TEST(ForwardKinematics, OfTwoHingesIsWhatGeometrySays) {
  const KinematicModel model = testing::StickModel();
  Posture posture = ZeroPosture(model);
  posture.position = {1, 2, 3};
  posture.orientation = Exp({0, 0, M_PI / 2});  // x -> y, y -> -x
  posture.joint_angles << M_PI / 6, M_PI / 3;   // about x: z leans towards -y, here towards +x
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
  ASSERT_EQ(X_WS.size(), 4u);
  EXPECT_TRUE(X_WS[1].translation().isApprox(Eigen::Vector3d(1, 2, 3.5), kRounding));
  const Eigen::Vector3d hip(1 + 0.25, 2, 3.5 + 0.5 * std::sqrt(0.75));
  EXPECT_TRUE(X_WS[2].translation().isApprox(hip, kRounding));
  EXPECT_TRUE(X_WS[3].translation().isApprox(hip + Eigen::Vector3d(0.1, 0, 0), kRounding));
  const Eigen::Matrix3Xd p_WM = MarkerPositions(model, posture);
  ASSERT_EQ(p_WM.cols(), 4);
  EXPECT_TRUE(p_WM.col(0).isApprox(Eigen::Vector3d(1, 2.1, 3), kRounding));
  EXPECT_TRUE(p_WM.col(1).isApprox(Eigen::Vector3d(0.9, 2, 3), kRounding));
  EXPECT_TRUE(p_WM.col(3).isApprox(hip + Eigen::Vector3d(0.3, 0, 0), kRounding));
}

TEST(ForwardKinematics, PrismaticAndStiffNodesStayAtZero) {
  ModelDescription description;
  description.segments.resize(3);
  description.segments[0].name = "root";
  description.segments[1] = {"length",
                             0,
                             Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.4)),
                             JointType::kPrismatic,
                             Eigen::Vector3d::UnitZ(),
                             0.0,
                             0.4};
  description.segments[2] = {
      "stiff", 1,  Eigen::Isometry3d::Identity(), JointType::kRevolute, Eigen::Vector3d::UnitX(),
      0.7,     0.7};
  const KinematicModel model(description);
  const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, ZeroPosture(model));
  EXPECT_EQ(X_WS[2].translation(), Eigen::Vector3d(0, 0, 0.4));
  EXPECT_EQ(X_WS[2].linear(), Eigen::Matrix3d::Identity());
}

TEST(ForwardKinematics, CenterOfMassIsTheWeightedMean) {
  ModelDescription description;
  description.segments.resize(2);
  description.segments[0].name = "root";
  description.segments[0].mass = 3;
  description.segments[0].p_SB = {0, 0, 1};
  description.segments[1].name = "arm";
  description.segments[1].parent = 0;
  description.segments[1].X_PF.translation().x() = 2;
  description.segments[1].mass = 1;
  description.segments[1].p_SB = {0, 4, 0};
  const KinematicModel model(description);
  const Eigen::Vector3d expected(0.5, 1, 0.75);
  EXPECT_TRUE(CenterOfMass(model, ZeroPosture(model)).isApprox(expected, kRounding));
}

TEST(ForwardKinematics, CenterOfMassNeedsAMass) {
  ModelDescription description;
  description.segments.resize(1);
  description.segments[0].name = "root";
  const KinematicModel model(description);
  EXPECT_THAT([&] { CenterOfMass(model, ZeroPosture(model)); },
              ThrowsMessage<Error>(HasSubstr("has no mass")));
}

}  // namespace
}  // namespace mmm_converter
