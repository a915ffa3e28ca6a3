// SPDX-License-Identifier: MIT
#include "common/retarget/smpl_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "tests/common/retarget/squat.h"
#include "tests/support/random_posture.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct LimbJoint {
  int joint, parent;  ///< SmplJoints()
  const char *place, *above;
};
const LimbJoint kLimbs[] = {{4, 1, "LKx_joint", "LHx_joint"},   {5, 2, "RKx_joint", "RHx_joint"},
                            {7, 4, "LAx_joint", "LKx_joint"},   {8, 5, "RAx_joint", "RKx_joint"},
                            {18, 16, "LEx_joint", "LSx_joint"}, {19, 17, "REx_joint", "RSx_joint"},
                            {20, 18, "LWx_joint", "LEx_joint"}, {21, 19, "RWx_joint", "REx_joint"}};

PoseTrajectory Moving(const KinematicModel& person) {
  PoseTrajectory motion = testing::Squat(person);
  SeededRandom random(3);
  motion.postures.resize(20);
  for (Posture& posture : motion.postures) {
    posture = testing::RandomPosture(person, random);
    posture.joint_angles *= 0.4;
  }
  return motion;
}

/// What the equations of SMPL give.
Matrix3Xd PlacesOf(const SmplMotion& motion, const Matrix3Xd& rest, int k) {
  Matrix3Xd p(3, kSmplJoints);
  std::vector<Matrix3d> R;
  p.col(0) = rest.col(0) + motion.translation.col(k);
  for (int j = 0; j < kSmplJoints; ++j) {
    const Matrix3d local = Exp(motion.poses.col(k).segment<3>(3 * j)).toRotationMatrix();
    const int parent = SmplJoints()[static_cast<std::size_t>(j)].parent;
    if (parent < 0) {
      R.push_back(local);
      continue;
    }
    R.push_back(R[static_cast<std::size_t>(parent)] * local);
    p.col(j) =
        p.col(parent) + R[static_cast<std::size_t>(parent)] * (rest.col(j) - rest.col(parent));
  }
  return p;
}

TEST(SmplMotion, LimbsHaveTheirDirectionsInAnyModel) {
  const KinematicModel person = testing::Person(1.8);
  const PoseTrajectory motion = Moving(person);
  for (const SmplKind kind : {SmplKind::kSmplH, SmplKind::kSmplX}) {
    const SmplModel smpl = StandInSmplModel(kind);
    const SmplMotion made = MakeSmplMotion(person, motion, smpl);
    for (int k = 0; k < motion.num_frames(); ++k) {
      const Matrix3Xd p = PlacesOf(made, smpl.joints, k);
      const auto X = SegmentPoses(person, ModelPosture(person, motion, k));
      for (const LimbJoint& limb : kLimbs) {
        const Vector3d bone = X[person.FindSegment(limb.place)].translation() -
                              X[person.FindSegment(limb.above)].translation();
        const Vector3d of_smpl = p.col(limb.joint) - p.col(limb.parent);
        EXPECT_LT((bone.normalized() - of_smpl.normalized()).norm(), 1e-6) << limb.place;
      }
    }
  }
}

TEST(SmplMotion, AModelThatCanHaveThePersonsShapeHasIt) {
  const KinematicModel person = testing::Person(1.9);
  PoseTrajectory motion = testing::Squat(person);
  SmplModel smpl = StandInSmplModel(SmplKind::kSmplH);
  for (int axis = 0; axis < 3; ++axis) {  // all of it, legs, arms
    Matrix3Xd wide = 0.05 * smpl.joints;
    if (axis == 1) wide.rightCols(10).setZero();
    if (axis == 2) wide.leftCols(16).setZero();
    smpl.directions.push_back(wide);
    wide.topRows(1).setZero();
    smpl.directions.push_back(wide);
  }
  const SmplMotion made = MakeSmplMotion(person, motion, smpl);
  ASSERT_EQ(made.betas.size(), 6U);
  double far = 0;
  for (int k = 0; k < motion.num_frames(); ++k) {
    const Matrix3Xd p = PlacesOf(made, smpl.Joints(made.betas), k);
    const auto X = SegmentPoses(person, ModelPosture(person, motion, k));
    for (const LimbJoint& limb : kLimbs) {
      far = std::max(far,
                     (X[person.FindSegment(limb.place)].translation() - p.col(limb.joint)).norm());
    }
  }
  EXPECT_LT(far, 0.006);
}

}  // namespace
}  // namespace mmm_converter
