// SPDX-License-Identifier: MIT
#include "plugins/jacobian/damped_steps.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "common/model/forward_kinematics.h"
#include "tests/support/test_models.h"

namespace mmm_converter::jacobian {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class DampedStepsTest : public ::testing::Test {
 protected:
  DampedStepsTest() {
    options_.cost.natural_weight = 0;
    options_.limit = 10;
    q_ = testing::RandomPosture(kinematics_, 0.5, &random_);
    target_ = testing::RandomPosture(kinematics_, 0.5, &random_);
  }

  Matrix3Xd Markers(const Posture& q) const {
    MarkerJacobian at = kinematics_.MakeJacobian();
    kinematics_.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    return at.p_WM;
  }

  const KinematicModel model_ = testing::MakeBranchedModel();
  const MarkerKinematics kinematics_ = testing::MakeFullKinematics(model_);
  const VectorXd scale_ = VectorXd::Ones(kinematics_.num_markers());
  DampedSteps steps_{kinematics_};
  DampedStepOptions options_;
  std::mt19937 random_{1};
  Posture q_, target_;
};

TEST_F(DampedStepsTest, IsTheDampedLeastSquaresStep) {
  options_.damping = 0.3;
  MarkerJacobian at = kinematics_.MakeJacobian();
  kinematics_.ComputeMarkers(q_.position, q_.orientation.toRotationMatrix(), q_.joint_angles, &at);
  kinematics_.ComputeJacobian(&at);
  MatrixXd J = at.J_transposed.view().transpose();
  const Matrix3Xd offset = 0.001 * Matrix3Xd::Random(3, kinematics_.num_markers());
  MatrixXd H = J.transpose() * J;
  H.diagonal().tail(kinematics_.num_dofs() - 3).array() += 0.09;
  const VectorXd expected = H.fullPivLu().solve(J.transpose() * offset.reshaped());

  Posture q = q_;
  const double asked = steps_.Step(at.p_WM + offset, scale_, options_, &q);
  // The root's tiny curvature of 1e-9 and rounding.
  EXPECT_LT((Local(q_, q) - expected).norm(), 1e-7 * expected.norm() + 1e-12);
  EXPECT_LE(asked, expected.norm());
}

TEST_F(DampedStepsTest, TheLimitCutsEachJointAndTheRootsRotationOnly) {
  Posture free = q_;
  Posture limited = q_;
  const double asked = steps_.Step(Markers(target_), scale_, options_, &free);
  constexpr double kLimit = 0.1;
  options_.limit = kLimit;
  EXPECT_EQ(steps_.Step(Markers(target_), scale_, options_, &limited), asked);
  ASSERT_GT(asked, kLimit);
  const VectorXd expected =
      (q_.joint_angles + (free.joint_angles - q_.joint_angles).cwiseMax(-kLimit).cwiseMin(kLimit))
          .cwiseMax(kinematics_.lower())
          .cwiseMin(kinematics_.upper());
  // Rounding.
  EXPECT_LT((limited.joint_angles - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((free.joint_angles - limited.joint_angles).cwiseAbs().maxCoeff(), 0);
  EXPECT_LE(Local(q_, limited).segment<3>(3).norm(), kLimit + 1e-12);
  EXPECT_EQ(limited.position, free.position);
}

TEST_F(DampedStepsTest, AJointThatPressesOnItsLimitIsHeldAndSlowsNobodyDown) {
  constexpr int kJoint = 1;
  q_.joint_angles[kJoint] = kinematics_.upper()[kJoint];
  Posture beyond = q_;
  beyond.joint_angles[kJoint] += 0.05;
  beyond.joint_angles[0] += 0.01;
  MarkerJacobian at = kinematics_.MakeJacobian();
  kinematics_.ComputeMarkers(q_.position, q_.orientation.toRotationMatrix(), q_.joint_angles, &at);
  kinematics_.ComputeJacobian(&at);
  MatrixXd J = at.J_transposed.view().transpose();
  const Matrix3Xd z = Markers(beyond);
  const VectorXd residual = (z - at.p_WM).reshaped();
  ASSERT_GT(J.col(6 + kJoint).dot(residual), 0);
  // The problem without the joint.
  J.col(6 + kJoint).setZero();
  MatrixXd H = J.transpose() * J;
  H.diagonal().tail(kinematics_.num_dofs() - 3).array() += options_.damping * options_.damping;
  const VectorXd expected = H.fullPivLu().solve(J.transpose() * residual);

  Posture q = q_;
  const double asked = steps_.Step(z, scale_, options_, &q);
  // The root's tiny curvature of 1e-9 and rounding.
  EXPECT_LT((Local(q_, q) - expected).norm(), 1e-7 * expected.norm() + 1e-12);
  EXPECT_EQ(q.joint_angles[kJoint], q_.joint_angles[kJoint]);
  EXPECT_LE(asked, expected.norm() * (1 + 1e-6));
}

TEST_F(DampedStepsTest, ManyStepsReachAReachableTarget) {
  options_.damping = 0.01;
  options_.limit = 0.1;
  const Matrix3Xd z = Markers(target_);
  Posture q = target_;
  q.position += Eigen::Vector3d(0.1, -0.2, 0.05);
  q.joint_angles += VectorXd::Constant(q.joint_angles.size(), 0.05);
  for (int i = 0; i < 200; ++i) steps_.Step(z, scale_, options_, &q);
  EXPECT_LT((Markers(q) - z).colwise().norm().maxCoeff(), 1e-6);
}

TEST_F(DampedStepsTest, JointLimitsHold) {
  Matrix3Xd z = Markers(target_);
  z *= 3;  // out of reach
  for (int i = 0; i < 50; ++i) {
    steps_.Step(z, scale_, options_, &q_);
    EXPECT_TRUE((q_.joint_angles.array() >= kinematics_.lower().array()).all());
    EXPECT_TRUE((q_.joint_angles.array() <= kinematics_.upper().array()).all());
  }
}

TEST_F(DampedStepsTest, WithoutMarkersNothingMoves) {
  const Posture before = q_;
  const Matrix3Xd nothing = Matrix3Xd::Constant(3, kinematics_.num_markers(), kNaN);
  EXPECT_EQ(steps_.Step(nothing, scale_, options_, &q_), 0);
  EXPECT_EQ(q_.joint_angles, before.joint_angles);
  EXPECT_EQ(q_.position, before.position);
}

}  // namespace
}  // namespace mmm_converter::jacobian
