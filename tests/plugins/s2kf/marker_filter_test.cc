// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_filter.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <random>

#include "tests/support/test_models.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class MarkerFilterTest : public ::testing::TestWithParam<FilterType> {
 protected:
  MarkerFilterTest() {
    settings_.filter = GetParam();
    settings_.samples = 101;
  }

  Eigen::Matrix3Xd Markers(const Posture& q) {
    MarkerJacobian at = kinematics_.MakeJacobian();
    kinematics_.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    return at.p_WM;
  }

  static UpdateOutcome Update(const Eigen::Matrix3Xd& z, Belief* belief, MarkerFilter* filter) {
    UpdateOutcome outcome = filter->MakeOutcome();
    filter->Update(z, belief, &outcome);
    return outcome;
  }

  KinematicModel model_ = testing::MakeBranchedModel();
  MarkerKinematics kinematics_ = testing::MakeFullKinematics(model_);
  VectorXd scale_ = VectorXd::Ones(kinematics_.num_markers());
  S2kfSettings settings_;
  std::mt19937 random_{5};
};

TEST_P(MarkerFilterTest, ConvergesToThePostureThatMadeTheMarkers) {
  settings_.natural_spread = 0;
  MarkerFilter filter(kinematics_, settings_, scale_);
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  const Eigen::Matrix3Xd z = Markers(truth);
  Belief belief;
  filter.StartAt(Retract(truth, 0.05 * VectorXd::Ones(kinematics_.num_dofs())), &belief);
  for (int k = 0; k < 30; ++k) {
    filter.Predict(0.01, &belief);
    Update(z, &belief, &filter);
  }
  Posture q;
  filter.ToPosture(belief, &q);
  // The mean over a spread is not the marker of the mean: a bias of second order stays.
  EXPECT_LT((Markers(q) - z).colwise().norm().maxCoeff(), 0.001);
}

TEST_P(MarkerFilterTest, AMissingMarkerIsAFilterWithoutIt) {
  MarkerFilter all(kinematics_, settings_, scale_);
  std::vector<MarkerIx> kept;
  for (const int m : {0, 1, 2, 3, 5, 6, 7, 8, 10, 11}) kept.emplace_back(m);
  const MarkerKinematics fewer_kinematics(model_, kinematics_.joints(), kept);
  MarkerFilter fewer(fewer_kinematics, settings_, VectorXd::Ones(10));
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  Eigen::Matrix3Xd z = Markers(truth);
  const Eigen::Matrix3Xd z_kept = z(Eigen::all, kept);
  for (const int hidden : {4, 9}) z.col(hidden).setConstant(kNaN);
  Belief a;
  Belief b;
  all.StartAt(Retract(truth, 0.02 * VectorXd::Ones(kinematics_.num_dofs())), &a);
  b = a;
  EXPECT_EQ(Update(z, &a, &all).seen, 10);
  Update(z_kept, &b, &fewer);
  // The same sums with zeros between.
  EXPECT_LT((a.P - b.P).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((a.parameters - b.parameters).norm(), 1e-11);
  EXPECT_LT((a.position - b.position).norm(), 1e-11);
}

TEST_P(MarkerFilterTest, WhatIsPreparedChangesNoResult) {
  MarkerFilter plain(kinematics_, settings_, scale_);
  MarkerFilter prepared(kinematics_, settings_, scale_);
  Belief a;
  plain.StartAt(testing::RandomPosture(kinematics_, 0.1, &random_), &a);
  Belief b = a;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Matrix3Xd z = Markers(testing::RandomPosture(kinematics_, 0.1, &random_));
    Belief expected = b;
    prepared.Predict(0.01, &expected);
    prepared.Prepare(expected);
    // Of every third frame another time is prepared for; one is updated twice.
    for (Belief* belief : {&a, &b}) plain.Predict(k % 3 == 2 ? 0.02 : 0.01, belief);
    const Belief prior = b;
    Update(z, &a, &plain);
    for (int i = 0; i < (k == 1 ? 2 : 1); ++i) {
      b = prior;
      Update(z, &b, &prepared);
    }
    EXPECT_TRUE(a == b) << k;
  }
}

TEST_P(MarkerFilterTest, NothingSeenLeavesThePrediction) {
  MarkerFilter filter(kinematics_, settings_, scale_);
  Belief belief;
  filter.StartAt(testing::RandomPosture(kinematics_, 0.6, &random_), &belief);
  filter.Predict(0.01, &belief);
  const Belief before = belief;
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Constant(3, kinematics_.num_markers(), kNaN);
  EXPECT_EQ(Update(none, &belief, &filter).seen, 0);
  EXPECT_EQ(belief.position, before.position);
  EXPECT_EQ(belief.parameters, before.parameters);
  EXPECT_EQ(belief.P, before.P);
}

TEST_P(MarkerFilterTest, OneWildMarkerIsHeldOff) {
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  Eigen::Matrix3Xd z = Markers(truth);
  z.col(6) += Eigen::Vector3d(0.5, 0.5, -0.5);
  double error[2] = {};
  for (const bool robust : {false, true}) {
    settings_.robust_distance = robust ? 0.02 : 0.0;
    MarkerFilter filter(kinematics_, settings_, scale_);
    Belief belief;
    filter.StartAt(truth, &belief);
    const UpdateOutcome outcome = Update(z, &belief, &filter);
    EXPECT_EQ(outcome.downweighted > 0, robust);
    Posture q;
    filter.ToPosture(belief, &q);
    error[robust] = (Markers(q) - Markers(truth)).norm();
  }
  EXPECT_LT(error[1], 0.5 * error[0]);
}

TEST_P(MarkerFilterTest, TheCovarianceStaysOneAndBoundedThroughLongGaps) {
  MarkerFilter filter(kinematics_, settings_, scale_);
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  std::normal_distribution<double> noise(0, 0.005);
  Belief belief;
  filter.StartAt(truth, &belief);
  VectorXd seen_deviations;
  VectorXd deviations;
  for (int k = 0; k < 1000; ++k) {
    Eigen::Matrix3Xd z = Markers(truth);
    for (double& value : z.reshaped()) value += noise(random_);
    // The last joints' markers are gone in the second half.
    if (k >= 500) z.rightCols(4).setConstant(kNaN);
    filter.Predict(0.01, &belief);
    Update(z, &belief, &filter);
    EXPECT_EQ(belief.P, belief.P.transpose());
    if (k == 499) filter.Deviations(belief, &seen_deviations);
  }
  filter.Deviations(belief, &deviations);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(belief.P);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
  const int hidden = 6 + model_.FindJoint("d_x");
  EXPECT_GT(deviations[hidden], 5 * seen_deviations[hidden]);
  EXPECT_LT(std::sqrt(belief.P(hidden, hidden)), 1.1 * settings_.natural_spread);
}

TEST_P(MarkerFilterTest, TheCovarianceStaysPositiveWhileMarkersComeAndGo) {
  MarkerFilter filter(kinematics_, settings_, scale_);
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  std::normal_distribution<double> noise(0, 0.005);
  std::bernoulli_distribution is_hidden(0.33);
  Belief belief;
  filter.StartAt(truth, &belief);
  VectorXd start;
  VectorXd end;
  filter.Deviations(belief, &start);
  for (int k = 0; k < 1000; ++k) {
    Eigen::Matrix3Xd z = Markers(truth);
    for (double& value : z.reshaped()) value += noise(random_);
    for (auto marker : z.colwise()) {
      if (is_hidden(random_)) marker.setConstant(kNaN);
    }
    filter.Predict(0.01, &belief);
    Update(z, &belief, &filter);
    ASSERT_EQ(belief.P, belief.P.transpose()) << "frame " << k;
    ASSERT_EQ(Eigen::LLT<MatrixXd>(belief.P).info(), Eigen::Success) << "frame " << k;
  }
  filter.Deviations(belief, &end);
  // Of the orientation, which all markers tell.
  EXPECT_LT(end.segment<3>(3).norm(), start.segment<3>(3).norm());
}

TEST_P(MarkerFilterTest, FoldingKeepsThePosture) {
  MarkerFilter filter(kinematics_, settings_, scale_);
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  Belief near;
  filter.StartAt(Retract(truth, 0.02 * VectorXd::Ones(kinematics_.num_dofs())), &near);
  Belief far = near;
  far.parameters.array() += 2 * EIGEN_PI;
  Update(Markers(truth), &near, &filter);
  Update(Markers(truth), &far, &filter);
  filter.Predict(0.01, &near);
  filter.Predict(0.01, &far);
  EXPECT_LE(far.parameters.cwiseAbs().maxCoeff(), EIGEN_PI / 2);
  // The sine of an argument that is rounded at 2 pi, through one update.
  EXPECT_LT((far.parameters - near.parameters).norm(), 1e-11);
  EXPECT_LT((far.position - near.position).norm(), 1e-11);
  EXPECT_LT((far.P - near.P).norm(), 1e-11);
}

TEST_P(MarkerFilterTest, RunsAreTheSameToTheLastBit) {
  const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
  const Eigen::Matrix3Xd z = Markers(truth);
  Belief belief[2];
  for (Belief& b : belief) {
    MarkerFilter filter(kinematics_, settings_, scale_);
    filter.StartAt(Retract(truth, 0.05 * VectorXd::Ones(kinematics_.num_dofs())), &b);
    for (int k = 0; k < 10; ++k) {
      filter.Predict(0.01, &b);
      Update(z, &b, &filter);
    }
  }
  EXPECT_EQ(belief[0].P, belief[1].P);
  EXPECT_EQ(belief[0].parameters, belief[1].parameters);
}

TEST_P(MarkerFilterTest, StartsAsThePaperDoes) {
  MarkerFilter filter(kinematics_, settings_, scale_);
  Eigen::Matrix3Xd z = Eigen::Matrix3Xd::Constant(3, kinematics_.num_markers(), kNaN);
  z.col(0) << 1, 0, 0;
  z.col(1) << 3, 0, 0;
  z.col(2) << 2, 3, 0;
  Belief belief;
  filter.StartAsPaper(z, &belief);
  EXPECT_EQ(belief.position, Eigen::Vector3d(2, 1, 0));
  EXPECT_EQ(belief.parameters, VectorXd::Zero(kinematics_.num_joints()));
  EXPECT_NEAR(belief.P(0, 0), 1, 1e-15);  // of 1, 3 and 2
  EXPECT_NEAR(belief.P(1, 1), 3, 1e-15);  // of 0, 0 and 3
  EXPECT_EQ(belief.P(4, 4), 1e-6);
  EXPECT_EQ(belief.P(7, 7), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Filters, MarkerFilterTest,
                         ::testing::Values(FilterType::kS2kf, FilterType::kUkf, FilterType::kEkf));

}  // namespace
}  // namespace mmm_converter::s2kf
