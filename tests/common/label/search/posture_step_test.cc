// SPDX-License-Identifier: MIT
#include "common/label/search/posture_step.h"

#include <gtest/gtest.h>

#include "common/label/tuning.h"
#include "common/math/seeded_random.h"
#include "common/support/units.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

TEST(PostureStepTest, AtTheTargetsNothingMoves) {
  const MadePerson made(21);
  NormalEquations equations(made.body.kinematics);
  Posture posture;
  posture.joint_angles = made.body.natural_angles;
  const Matrix3Xd targets = equations.Place(posture);
  const Posture before = posture;
  StepTowards(targets, VectorXd::Constant(targets.cols(), 0.01), StepTuning::kNoRobustDistance,
              made.body, &equations, &posture);
  EXPECT_LT((posture.position - before.position).norm(), 1e-12);
  EXPECT_LT((posture.joint_angles - before.joint_angles).norm(), 1e-9);
}

TEST(PostureStepTest, StepsComeToTheTargets) {
  const MadePerson made(22);
  NormalEquations equations(made.body.kinematics);
  const Matrix3Xd targets = equations.Place(made.PostureAt(0));
  Posture posture = made.PostureAt(0);
  posture.position.x() += 0.1;
  posture.joint_angles = 0.8 * posture.joint_angles;
  for (int i = 0; i < 15; ++i) {
    equations.Place(posture);
    StepTowards(targets, VectorXd::Constant(targets.cols(), 0.001), StepTuning::kNoRobustDistance,
                made.body, &equations, &posture);
  }
  EXPECT_LT((equations.Place(posture) - targets).colwise().norm().maxCoeff(), 0.002);
}

TEST(PostureStepTest, NoStepIsLongerThanAngleOrLimitAllow) {
  const MadePerson made(23);
  SeededRandom random(23);
  NormalEquations equations(made.body.kinematics);
  for (int i = 0; i < 20; ++i) {
    Posture posture = made.PostureAt(0);
    const Posture before = posture;
    Matrix3Xd targets = equations.Place(posture);
    for (double& x : targets.reshaped()) x += random.Normal();
    StepTowards(targets, VectorXd::Constant(targets.cols(), 0.01), StepTuning::kNoRobustDistance,
                made.body, &equations, &posture);
    const VectorXd moved = posture.joint_angles - before.joint_angles;
    EXPECT_LE(moved.lpNorm<Eigen::Infinity>(), 0.6 + 1e-12);
    EXPECT_LE(before.orientation.angularDistance(posture.orientation), 0.6 * std::sqrt(3) + 1e-9);
    EXPECT_TRUE((posture.joint_angles.array() >= made.body.kinematics.lower().array()).all());
    EXPECT_TRUE((posture.joint_angles.array() <= made.body.kinematics.upper().array()).all());
  }
}

TEST(PostureStepTest, WhatNoTargetMovesTendsToItsNaturalAngle) {
  const MadePerson made(24);
  NormalEquations equations(made.body.kinematics);
  Posture posture = made.PostureAt(0);
  const Matrix3Xd unseen = Matrix3Xd::Constant(3, made.body.num_markers(), kNaN);
  const double before = (posture.joint_angles - made.body.natural_angles).norm();
  equations.Place(posture);
  StepTowards(unseen, VectorXd::Constant(unseen.cols(), 0.01), StepTuning::kNoRobustDistance,
              made.body, &equations, &posture);
  EXPECT_LT((posture.joint_angles - made.body.natural_angles).norm(), 0.7 * before);
}

}  // namespace
}  // namespace mmm_converter::testing
