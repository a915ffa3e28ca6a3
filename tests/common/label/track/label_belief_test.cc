// SPDX-License-Identifier: MIT
#include "common/label/track/label_belief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/label/tuning.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

class LabelBeliefTest : public ::testing::Test {
 protected:
  LabelBeliefTest()
      : model_(ScaledReferenceModel(1.7)),
        body_(SetupOf(model_, TrackedJoints(model_), AllMarkers())),
        belief_(BeliefAt(body_, Still())),
        points_(body_.num_markers(), 0) {}

  std::vector<MarkerAssignment> AllMarkers() const {
    return AssignAll(model_, RecordPerson(model_, RangeOfMotion(model_, 0.1, 0.5, 1), 1));
  }

  Posture Still() const {
    Posture posture;
    posture.joint_angles = body_.natural_angles;
    return posture;
  }

  // Frames in which the root is seen to move by v dt [m], all dofs to 1 mm and 1 mrad.
  void See(double v, int frames, double dt) {
    for (int i = 0; i < frames; ++i) {
      belief_.Predict(body_, dt);
      const Eigen::MatrixXd prior = belief_.P_qq.inverse();
      Eigen::MatrixXd information = prior;
      information.diagonal().array() += 1e6;
      Posture seen = Still();
      seen.position.x() = x_ += v * dt;
      belief_.Correct(prior, seen, information.inverse(), &scratch_);
      belief_.ExpectSpeeds(body_, points_, dt);
    }
  }

  // [m] of the root's place along x after dt.
  double DeviationAfter(double dt) const {
    LabelBelief later = belief_;
    later.Predict(body_, dt);
    return std::sqrt(later.P_qq(0, 0));
  }

  int Dof(const std::string& joint) const {
    const auto& joints = body_.kinematics.joints();
    const auto found = std::find(joints.begin(), joints.end(), model_.FindJoint(joint));
    EXPECT_NE(found, joints.end()) << joint;
    return 6 + static_cast<int>(found - joints.begin());
  }

  KinematicModel model_;
  LabelBody body_;
  LabelBelief::Scratch scratch_ = LabelBelief::Scratch(body_.kinematics.num_dofs());
  LabelBelief belief_;
  std::vector<int> points_;  // all markers have one
  double x_ = 0;             // [m]
};

TEST_F(LabelBeliefTest, WhoStandsIsForeseenToStand) {
  const double before = DeviationAfter(0.1);
  See(0, 20, 0.1);
  EXPECT_GT(before, 0.05);
  EXPECT_LT(DeviationAfter(0.1), 0.01);
  EXPECT_NEAR(belief_.speed[0], 0.05 * MovementTuning::kRoot.speed, 0.02);
}

TEST_F(LabelBeliefTest, WhoSetsOffIsForeseenToMove) {
  See(0, 20, 0.1);
  See(0.8, 2, 0.1);
  EXPECT_GE(belief_.speed[0], std::abs(belief_.velocity[0]));
  EXPECT_GT(belief_.velocity[0], 0.4);
  EXPECT_GT(DeviationAfter(0.1), 0.03);
  EXPECT_LE(belief_.speed[0], MovementTuning::kRoot.speed);
}

TEST_F(LabelBeliefTest, WhatIsNotSeenCanDoAnything) {
  const int ankle = Dof("LAx_joint");
  const int other = Dof("RAx_joint");
  const double most = belief_.speed[ankle];
  See(0, 20, 0.1);
  ASSERT_LT(belief_.speed[ankle], 0.1 * most);
  for (int m = 0; m < body_.num_markers(); ++m) {
    if (body_.kinematics.Moves(ankle - 6, m)) points_[m] = -1;
  }
  See(0, 20, 0.1);
  EXPECT_GT(belief_.speed[ankle], 0.95 * most);
  EXPECT_LT(belief_.speed[other], 0.1 * most);
}

TEST_F(LabelBeliefTest, BackInTimeTheVelocityIsTheOpposite) {
  See(0.8, 5, 0.1);
  const double there = belief_.PostureAfter(body_, 0.1).position.x() - belief_.posture.position.x();
  belief_.Reverse();
  const double back = belief_.PostureAfter(body_, 0.1).position.x() - belief_.posture.position.x();
  EXPECT_GT(there, 0.02);
  EXPECT_DOUBLE_EQ(back, -there);
}

}  // namespace
}  // namespace mmm_converter::testing
