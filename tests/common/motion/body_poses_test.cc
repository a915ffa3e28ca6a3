// SPDX-License-Identifier: MIT
#include "common/motion/body_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/trajectory_derivatives.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;

// Root and all joints swing; 1 kHz, so that central differences are exact to some 1e-4.
PoseTrajectory Swinging(const KinematicModel& model) {
  PoseTrajectory motion;
  motion.rate = 1000;
  motion.first_time = 2;
  for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
  for (int k = 0; k < 60; ++k) {
    Posture q;
    const double t = motion.time(k);
    q.position = {0.1 * std::sin(3 * t), 0.2 * t, 1 + 0.1 * std::cos(2 * t)};
    q.orientation = Exp({std::sin(t), 0.5 * std::sin(2 * t), 3 * t});
    q.joint_angles.resize(model.num_joints());
    for (int j = 0; j < model.num_joints(); ++j) q.joint_angles[j] = 0.3 + 0.2 * std::sin(t + j);
    motion.postures.push_back(q);
  }
  return motion;
}

KinematicModel HeavyModel() {
  const KinematicModel light = testing::MakeBranchedModel();
  ModelDescription description;
  description.name = "heavy";
  description.segments = light.segments();
  for (std::size_t i = 0; i < description.segments.size(); ++i) {
    description.segments[i].mass = static_cast<double>(i);
    description.segments[i].p_SB = {0.1, -0.02 * static_cast<double>(i), 0.05};
  }
  return KinematicModel(description);
}

BodySelection Everything(const KinematicModel& model) {
  BodySelection selection;
  for (std::size_t i = 0; i < model.segments().size(); ++i) {
    selection.segments.push_back(static_cast<int>(i));
  }
  selection.points = JointPoints(model);
  return selection;
}

Eigen::Quaterniond QuaternionAt(const BodyPoses& poses, int body, int k) {
  const Eigen::Vector4d q = poses.quaternions.col(k).segment<4>(4 * body);
  return {q[0], q[1], q[2], q[3]};
}

TEST(BodyPosesTest, AreThoseOfTheModel) {
  const KinematicModel model = HeavyModel();
  const PoseTrajectory motion = Swinging(model);
  BodySelection selection = Everything(model);
  for (const bool is_relative : {false, true}) {
    selection.relative_to_root = is_relative;
    const BodyPoses poses = ComputeBodyPoses(model, motion, selection);
    EXPECT_EQ(poses.velocities.size(), 0);
    for (int k = 0; k < motion.num_frames(); ++k) {
      const Posture q = ModelPosture(model, motion, k);
      const auto X_WS = SegmentPoses(model, q);
      const Eigen::Isometry3d X_BW =
          is_relative ? X_WS[0].inverse() : Eigen::Isometry3d::Identity();
      for (std::size_t i = 0; i < X_WS.size(); ++i) {
        const Eigen::Isometry3d X = X_BW * X_WS[i];
        const auto row = 3 * static_cast<Eigen::Index>(i);
        EXPECT_LT((poses.positions.col(k).segment<3>(row) - X.translation()).norm(), 1e-14);
        const auto R = QuaternionAt(poses, static_cast<int>(i), k).toRotationMatrix();
        EXPECT_LT((R - X.linear()).norm(), 1e-14);
      }
      for (std::size_t i = 0; i < selection.points.size(); ++i) {
        const Vector3d p = X_BW * X_WS[selection.points[i].segment].translation();
        const auto row = 3 * static_cast<Eigen::Index>(i);
        EXPECT_LT((poses.point_positions.col(k).segment<3>(row) - p).norm(), 1e-14);
      }
      EXPECT_LT((poses.center_of_mass.col(k) - X_BW * CenterOfMass(model, q)).norm(), 1e-14);
    }
  }
}

TEST(BodyPosesTest, VelocitiesAreDerivatives) {
  const KinematicModel model = HeavyModel();
  PoseTrajectory motion = Swinging(model);
  Differentiate(&motion);
  BodySelection selection = Everything(model);
  for (const bool is_relative : {false, true}) {
    selection.relative_to_root = is_relative;
    const BodyPoses poses = ComputeBodyPoses(model, motion, selection);
    const double rate = motion.rate;
    for (int k = 1; k + 1 < poses.num_frames(); ++k) {
      const auto difference = [&](const Eigen::MatrixXd& x) -> Eigen::VectorXd {
        return 0.5 * rate * (x.col(k + 1) - x.col(k - 1));
      };
      // Both are differences over 2 ms; third derivatives are below 100.
      const double near = 100.0 / (rate * rate);
      EXPECT_LT((difference(poses.positions) - poses.velocities.col(k)).lpNorm<Eigen::Infinity>(),
                near);
      EXPECT_LT((difference(poses.point_positions) - poses.point_velocities.col(k))
                    .lpNorm<Eigen::Infinity>(),
                near);
      EXPECT_LT((difference(poses.center_of_mass) - poses.center_of_mass_velocity.col(k)).norm(),
                near);
      for (int b = 0; b < poses.num_bodies(); ++b) {
        const Vector3d w =
            0.5 * rate *
            Log(QuaternionAt(poses, b, k + 1) * QuaternionAt(poses, b, k - 1).conjugate());
        EXPECT_LT((w - poses.angular_velocities.col(k).segment<3>(3 * b)).norm(), near);
      }
    }
  }
}

TEST(BodyPosesTest, SignsOfQuaternionsDoNotJump) {
  const KinematicModel model = testing::MakeBranchedModel();
  const BodyPoses poses = ComputeBodyPoses(model, Swinging(model), Everything(model));
  for (int k = 1; k < poses.num_frames(); ++k) {
    for (int b = 0; b < poses.num_bodies(); ++b) {
      EXPECT_GT(poses.quaternions.col(k).segment<4>(4 * b).dot(
                    poses.quaternions.col(k - 1).segment<4>(4 * b)),
                0.99);
    }
  }
}

TEST(BodyPosesTest, WithoutMassThereIsNoCentreOfMass) {
  ModelDescription description;
  description.segments = testing::MakeBranchedModel().segments();
  for (Segment& segment : description.segments) segment.mass = 0;
  const KinematicModel model(description);
  PoseTrajectory motion = Swinging(model);
  Differentiate(&motion);
  const BodyPoses poses = ComputeBodyPoses(model, motion, Everything(model));
  EXPECT_EQ(poses.center_of_mass.size(), 0);
  EXPECT_EQ(poses.center_of_mass_velocity.size(), 0);
  EXPECT_GT(poses.velocities.size(), 0);
}

TEST(BodyPosesTest, ObjectsAreTakenAtTheMotionsTimes) {
  const KinematicModel model = testing::MakeBranchedModel();
  PoseTrajectory motion = Swinging(model);
  motion.rate = 100;
  motion.first_time = 1;
  motion.postures.resize(6);  // 1.00 to 1.05 s
  ObjectMotion cup = {"cup", {}};
  cup.trajectory.rate = 50;
  cup.trajectory.first_time = 1.02;
  cup.trajectory.postures.resize(2);  // 1.02 and 1.04 s
  cup.trajectory.postures[1].position = {1, 0, 0};
  cup.trajectory.postures[1].orientation = Exp({0, 0, 1});
  BodySelection selection;
  selection.objects = {cup};
  const BodyPoses poses = ComputeBodyPoses(model, motion, selection);
  EXPECT_THAT(poses.objects, ::testing::ElementsAre("cup"));
  for (const int k : {0, 1, 5}) EXPECT_TRUE(poses.positions.col(k).hasNaN()) << k;
  for (const int k : {2, 3, 4}) {
    const double share = 0.5 * (k - 2);
    EXPECT_NEAR(poses.positions(0, k), share, 1e-12);
    EXPECT_LT((Log(QuaternionAt(poses, 0, k)) - Vector3d(0, 0, share)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace mmm_converter
