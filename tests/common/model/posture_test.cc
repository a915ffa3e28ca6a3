// SPDX-License-Identifier: MIT
#include "common/model/posture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"
#include "common/model/kinematic_model.h"
#include "tests/support/random_posture.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using testing::RandomPosture;
using testing::StickModel;

Eigen::VectorXd RandomTangent(Eigen::Index size, double scale, SeededRandom& random) {
  Eigen::VectorXd dq(size);
  for (double& value : dq) value = scale * random.Normal();
  return dq;
}

TEST(Posture, ZeroIsClampedIntoTheLimits) {
  ModelDescription description;
  description.segments.resize(3);
  for (int i = 0; i < 3; ++i)
    description.segments[i].name = std::string(1, static_cast<char>('a' + i));
  for (int i = 1; i < 3; ++i) {
    description.segments[i].parent = i - 1;
    description.segments[i].type = JointType::kRevolute;
  }
  description.segments[1].lower = 0.25;
  description.segments[1].upper = 1;
  description.segments[2].lower = -1;
  description.segments[2].upper = -0.5;
  const Posture zero = ZeroPosture(KinematicModel(description));
  EXPECT_EQ(zero.joint_angles, Eigen::Vector2d(0.25, -0.5));
  EXPECT_EQ(zero.position, Eigen::Vector3d::Zero());
  EXPECT_EQ(zero.orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(Posture, RetractTurnsAboutTheBodysOwnAxes) {
  Posture q;
  q.orientation = Exp({0, 0, M_PI / 2});  // the body's x points along y
  q.joint_angles = Eigen::Vector2d(0.1, 0.2);
  Eigen::VectorXd dq(8);
  dq << 1, 2, 3, M_PI / 2, 0, 0, 0.5, -0.5;
  const Posture moved = Retract(q, dq);
  // Tolerances: rounding of a few operations on numbers of about 1.
  EXPECT_TRUE(moved.position.isApprox(Eigen::Vector3d(1, 2, 3), 1e-15));
  EXPECT_TRUE(
      (moved.orientation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-14));
  EXPECT_TRUE(
      (moved.orientation * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-14));
  EXPECT_TRUE(moved.joint_angles.isApprox(Eigen::Vector2d(0.6, -0.3), 1e-15));
}

TEST(Posture, LocalIsTheInverseOfRetractAtEachScale) {
  const KinematicModel model = StickModel();
  SeededRandom random(1);
  for (const double scale : {0.0, 1e-8, 0.5}) {
    for (int i = 0; i < 20; ++i) {
      const Posture q = RandomPosture(model, random);
      const Eigen::VectorXd dq = RandomTangent(8, scale, random);
      // Positions of up to 2 m are rounded to 4e-16, quaternions likewise.
      EXPECT_NEAR((Local(q, Retract(q, dq)) - dq).norm(), 0, 1e-14) << "scale " << scale;
    }
  }
}

TEST(Posture, RetractIsTheInverseOfLocalForAnyTwoPostures) {
  const KinematicModel model = StickModel();
  SeededRandom random(2);
  for (int i = 0; i < 100; ++i) {
    const Posture a = RandomPosture(model, random);
    const Posture b = RandomPosture(model, random);
    const Posture back = Retract(a, Local(a, b));
    EXPECT_LT((back.position - b.position).norm(), 1e-14);
    EXPECT_LT(back.orientation.angularDistance(b.orientation), 1e-7);  // acos of 1 - 1e-16
    EXPECT_LT((back.joint_angles - b.joint_angles).norm(), 1e-14);
    EXPECT_LT(Local(a, a).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace mmm_converter
