// SPDX-License-Identifier: MIT
#include "common/model/marker_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using testing::MakeBranchedModel;
using testing::MakeFullKinematics;
using testing::RandomPosture;

// A chain of five rotations and offsets below 1 m: some tens of roundings of 1e-16.
constexpr double kMarkerRounding = 1e-14;

TEST(MarkerKinematicsTest, OnePostureEqualsTheModelsForwardKinematics) {
  const KinematicModel model = MakeBranchedModel();
  const MarkerKinematics kinematics = MakeFullKinematics(model);
  MarkerJacobian at = kinematics.MakeJacobian();
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Posture q = RandomPosture(kinematics, 1.0, &random);
    kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    EXPECT_LT((at.p_WM - MarkerPositions(model, q)).cwiseAbs().maxCoeff(), kMarkerRounding);
  }
}

TEST(MarkerKinematicsTest, UntrackedJointsStayAtZeroAndMarkersKeepTheirOrder) {
  const KinematicModel model = MakeBranchedModel();
  const std::vector<int> joints = {model.FindJoint("b_y"), model.FindJoint("a_x")};
  const std::vector<MarkerIx> markers = {MarkerIx(7), MarkerIx(0), MarkerIx(10)};
  const MarkerKinematics kinematics(model, joints, markers);
  MarkerJacobian at = kinematics.MakeJacobian();
  kinematics.ComputeMarkers({1, 2, 3}, Eigen::Matrix3d::Identity(), Eigen::Vector2d(0.3, -0.4),
                            &at);
  Posture q;
  q.position = {1, 2, 3};
  q.joint_angles.setZero(model.num_joints());
  q.joint_angles[joints[0]] = 0.3;
  q.joint_angles[joints[1]] = -0.4;
  const Eigen::Matrix3Xd expected = MarkerPositions(model, q);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((at.p_WM.col(i) - expected.col(markers[i])).norm(), kMarkerRounding);
  }
  EXPECT_TRUE(kinematics.Moves(0, 0));
  EXPECT_FALSE(kinematics.Moves(0, 1));
  EXPECT_FALSE(kinematics.Moves(1, 2));
}

TEST(MarkerKinematicsTest, BatchEqualsOnePostureAtATime) {
  const KinematicModel model = MakeBranchedModel();
  const MarkerKinematics kinematics = MakeFullKinematics(model);
  constexpr int kSamples = 21;  // not a multiple of the lanes
  MarkerBatch batch = kinematics.MakeBatch(kSamples);
  std::mt19937 random(3);
  std::vector<Posture> postures;
  for (int i = 0; i < kSamples; ++i) {
    const Posture q = RandomPosture(kinematics, 1.0, &random);
    batch.position.view().row(i) = q.position.transpose();
    const Eigen::Matrix3d R = q.orientation.toRotationMatrix();
    for (int r = 0; r < 3; ++r) batch.rotation.view().block<1, 3>(i, 3 * r) = R.row(r);
    batch.angles.view().row(i) = q.joint_angles.transpose();
    postures.push_back(q);
  }
  MarkerJacobian at = kinematics.MakeJacobian();
  for (const InstructionSet set : SupportedInstructionSets()) {
    batch.markers.view().setZero();
    kinematics.ComputeBatch(&batch, set);
    for (int i = 0; i < kSamples; ++i) {
      const Posture& q = postures[i];
      kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
      const Eigen::VectorXd row = batch.markers.view().row(i).transpose();
      EXPECT_LT((row - at.p_WM.reshaped()).cwiseAbs().maxCoeff(), kMarkerRounding)
          << ToString(set) << ", sample " << i;
    }
  }
}

TEST(MarkerKinematicsTest, JacobianMatchesFiniteDifferencesAtThreeScales) {
  const KinematicModel model = MakeBranchedModel();
  const MarkerKinematics kinematics = MakeFullKinematics(model);
  MarkerJacobian at = kinematics.MakeJacobian();
  MarkerJacobian moved = kinematics.MakeJacobian();
  std::mt19937 random(4);
  for (const double share : {0.0, 1e-8, 1.0}) {
    Posture q = RandomPosture(kinematics, share, &random);
    if (share == 0.0) q.orientation.setIdentity();
    kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    kinematics.ComputeJacobian(&at);
    for (int i = 0; i < kinematics.num_dofs(); ++i) {
      // Central differences: h^2 / 6 = 2e-11 and rounding 1e-16 / h = 1e-11, times lengths below 1
      // m.
      const double h = 1e-5;
      Eigen::VectorXd difference = Eigen::VectorXd::Zero(3 * kinematics.num_markers());
      for (const double sign : {1.0, -1.0}) {
        const Posture p = Retract(q, sign * h * Eigen::VectorXd::Unit(kinematics.num_dofs(), i));
        kinematics.ComputeMarkers(p.position, p.orientation.toRotationMatrix(), p.joint_angles,
                                  &moved);
        difference += sign * moved.p_WM.reshaped() / (2 * h);
      }
      EXPECT_LT((difference - at.J_transposed.view().row(i).transpose()).cwiseAbs().maxCoeff(),
                1e-9)
          << "share " << share << ", column " << i;
    }
  }
}

}  // namespace
}  // namespace mmm_converter
