// SPDX-License-Identifier: MIT
//
// One kinematics for all: what trackers compute of a model of coordinates, against the model's own
// forward kinematics, which is written to be read, and against finite differences.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/io/osim/osim_model_reader.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/model/marker_kinematics.h"
#include "tests/support/osim_texts.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using testing::MakeFullKinematics;
using testing::RandomPosture;

// Chains of some twenty turns and offsets below 1 m.
constexpr double kChainRounding = 1e-13;

KinematicModel AllKinds() { return ParseOsimModel(testing::OsimOfAllKinds(), "m.osim"); }

/// The same with ground as its root: a free coordinate of six is locked.
KinematicModel OnTheGround() {
  std::string text = testing::OsimOfAllKinds();
  const std::string tz = "<Coordinate name=\"tz\">";
  text.insert(text.find(tz) + tz.size(), "<locked>true</locked>");
  return ParseOsimModel(text, "m.osim");
}

TEST(OsimKinematics, OnePostureEqualsTheModels) {
  for (const KinematicModel& model : {AllKinds(), OnTheGround()}) {
    const MarkerKinematics kinematics = MakeFullKinematics(model);
    MarkerJacobian at = kinematics.MakeJacobian();
    std::mt19937 random(2);
    for (int i = 0; i < 50; ++i) {
      Posture q = RandomPosture(kinematics, 1.0, &random);
      if (model.is_root_fixed()) {
        const Posture zero = ZeroPosture(model);
        q.position = zero.position;
        q.orientation = zero.orientation;
      }
      kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
      EXPECT_LT((at.p_WM - MarkerPositions(model, q)).cwiseAbs().maxCoeff(), kChainRounding);
    }
  }
}

TEST(OsimKinematics, JacobianEqualsFiniteDifferences) {
  for (const KinematicModel& model : {AllKinds(), OnTheGround()}) {
    const MarkerKinematics kinematics = MakeFullKinematics(model);
    MarkerJacobian at = kinematics.MakeJacobian();
    MarkerJacobian near = kinematics.MakeJacobian();
    std::mt19937 random(3);
    for (int i = 0; i < 20; ++i) {
      const Posture q = RandomPosture(kinematics, 1.0, &random);
      kinematics.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
      kinematics.ComputeJacobian(&at);
      for (int dof = 0; dof < kinematics.num_dofs(); ++dof) {
        constexpr double kStep = 1e-5;  // central differences: rounding 1e-11, third order 1e-10
        Eigen::VectorXd dq = Eigen::VectorXd::Zero(kinematics.num_dofs());
        Eigen::Matrix3Xd slope = Eigen::Matrix3Xd::Zero(3, kinematics.num_markers());
        for (const double sign : {1.0, -1.0}) {
          dq[dof] = sign * kStep;
          const Posture moved = Retract(q, dq);
          kinematics.ComputeMarkers(moved.position, moved.orientation.toRotationMatrix(),
                                    moved.joint_angles, &near);
          slope += sign / (2 * kStep) * near.p_WM;
        }
        if (dof < 6 && model.is_root_fixed()) slope.setZero();
        const Eigen::VectorXd row =
            at.J_transposed.view().row(dof).head(3 * kinematics.num_markers());
        EXPECT_LT((row - slope.reshaped()).cwiseAbs().maxCoeff(), 1e-8) << "dof " << dof;
      }
    }
  }
}

TEST(OsimKinematics, BatchEqualsOnePostureAtATime) {
  const KinematicModel model = AllKinds();
  const MarkerKinematics kinematics = MakeFullKinematics(model);
  constexpr int kSamples = 21;  // not a multiple of the lanes
  MarkerBatch batch = kinematics.MakeBatch(kSamples);
  std::mt19937 random(4);
  std::vector<Posture> postures;
  for (int i = 0; i < kSamples; ++i) {
    const Posture& q = postures.emplace_back(RandomPosture(kinematics, 1.0, &random));
    const Eigen::Matrix3d R = q.orientation.toRotationMatrix();
    for (int k = 0; k < 9; ++k) batch.rotation.view()(i, k) = R(k / 3, k % 3);
    batch.position.view().row(i) = q.position.transpose();
    batch.angles.view().row(i).head(kinematics.num_joints()) = q.joint_angles.transpose();
  }
  kinematics.ComputeBatch(&batch);
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Matrix3Xd expected = MarkerPositions(model, postures[i]);
    const Eigen::VectorXd row = batch.markers.view().row(i).head(3 * kinematics.num_markers());
    EXPECT_LT((row - expected.reshaped()).cwiseAbs().maxCoeff(), kChainRounding);
  }
}

TEST(OsimKinematics, UntrackedJointsAreAtTheirDefaults) {
  const KinematicModel model = AllKinds();
  std::vector<int> joints;
  for (int j = 0; j < model.num_joints(); ++j) {
    if (model.joint(j).name != "knee_angle" && model.joint(j).name != "wheel_angle") {
      joints.push_back(j);
    }
  }
  const MarkerKinematics all = MakeFullKinematics(model);
  const MarkerKinematics some(model, joints, all.markers());
  MarkerJacobian at = some.MakeJacobian();
  std::mt19937 random(5);
  Posture q = RandomPosture(all, 1.0, &random);
  q.joint_angles[model.FindJoint("knee_angle")] = -0.3;
  q.joint_angles[model.FindJoint("wheel_angle")] = 0.7;
  some.ComputeMarkers(q.position, q.orientation.toRotationMatrix(),
                      Eigen::VectorXd(q.joint_angles(joints)), &at);
  EXPECT_LT((at.p_WM - MarkerPositions(model, q)).cwiseAbs().maxCoeff(), kChainRounding);
}

TEST(OsimCoordinates, TellThePostureAndBack) {
  const KinematicModel model = AllKinds();
  const MarkerKinematics kinematics = MakeFullKinematics(model);
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    const Posture q = RandomPosture(kinematics, 0.9, &random);
    CoordinateSeries series(model);
    const Posture again = PostureOf(model, series.Next(q));
    EXPECT_LT(Local(q, again).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// Turns of the root go through the quarter where Euler angles jump, and around several times.
TEST(OsimCoordinates, OfTheRootHaveNoJumps) {
  const KinematicModel model = AllKinds();
  CoordinateSeries series(model);
  Eigen::VectorXd values(model.coordinates()->coordinates().size());
  values.setZero();
  for (int k = 0; k < 2000; ++k) {
    values[0] = 0.2 * std::sin(0.01 * k);
    values[1] = 2.2 * std::sin(0.003 * k);
    values[2] = 0.01 * k;
    values[3] = 0.1;
    const Eigen::VectorXd read = series.Next(PostureOf(model, values));
    EXPECT_LT((read - values).head<6>().cwiseAbs().maxCoeff(), 1e-8) << k;
  }
}

TEST(OsimCoordinates, HaveTheDeviationsOfTheRoot) {
  const KinematicModel model = AllKinds();
  const MarkerKinematics kinematics = MakeFullKinematics(model);
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    const Posture q = RandomPosture(kinematics, 0.9, &random);
    CoordinateSeries series(model);
    const Eigen::VectorXd values = series.Next(q);
    for (int dof = 0; dof < 6 + model.num_joints(); ++dof) {
      constexpr double kStep = 1e-6;
      Eigen::VectorXd dq = Eigen::VectorXd::Zero(6 + model.num_joints());
      dq[dof] = kStep;
      CoordinateSeries moved = series;
      const Eigen::VectorXd slope = (moved.Next(Retract(q, dq)) - values).cwiseAbs() / kStep;
      dq[dof] = 1;
      const Eigen::VectorXd deviations = series.Deviations(q, dq);
      EXPECT_LT((slope - deviations).cwiseAbs().maxCoeff(),
                1e-4 * std::max(1.0, slope.maxCoeff()))  // one-sided differences
          << "dof " << dof;
    }
  }
}

}  // namespace
}  // namespace mmm_converter
