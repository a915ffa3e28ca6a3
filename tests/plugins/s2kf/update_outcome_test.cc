// SPDX-License-Identifier: MIT
// What an update leaves behind, against dense matrices: z = h + J dx + v at the prior's posture.
#include "plugins/s2kf/update_outcome.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "plugins/s2kf/marker_filter.h"
#include "tests/support/test_models.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Relative, of products and solves of some 20 states and 36 coordinates with P spread over 1e-4 to
// 1e-8.
constexpr double kRounding = 1e-9;

/// The filter with a Jacobian, which is the dense linear model to the last digits.
class UpdateOutcomeTest : public ::testing::TestWithParam<UpdateForm> {
 protected:
  UpdateOutcomeTest() {
    const Posture truth = testing::RandomPosture(kinematics_, 0.6, &random_);
    const Posture start = Retract(truth, 0.01 * VectorXd::Ones(kinematics_.num_dofs()));
    z_ = Markers(truth);
    for (const int hidden : kHidden) z_.col(hidden).setConstant(kNaN);
    filter_.StartAt(start, &prior_);
    MakeDenseModel();
  }

  static constexpr int kHidden[] = {3, 7};

  int num_markers() const { return kinematics_.num_markers(); }

  Matrix3Xd Markers(const Posture& q) const {
    MarkerJacobian at = kinematics_.MakeJacobian();
    kinematics_.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    return at.p_WM;
  }

  void MakeDenseModel() {
    Posture q;
    MarkerJacobian at = kinematics_.MakeJacobian();
    filter_.Place(prior_, &q, &at);
    kinematics_.ComputeJacobian(&at);
    h_ = at.p_WM.reshaped();
    H_ = at.J_transposed.view().transpose();
    for (int j = 0; j < kinematics_.num_joints(); ++j) {
      H_.col(6 + j) *= filter_.transform().Slope(j, prior_.parameters[j]);
    }
    S_ = H_ * prior_.P * H_.transpose();
    for (int m = 0; m < num_markers(); ++m) {
      const double deviation = settings_.marker_deviation * scale_[m];
      S_.diagonal().segment<3>(3 * m).array() += deviation * deviation;
    }
  }

  std::vector<int> Seen() const {
    std::vector<int> rows;
    for (int i = 0; i < 3 * num_markers(); ++i) {
      if (std::isfinite(z_.reshaped()[i])) rows.push_back(i);
    }
    return rows;
  }

  MatrixXd DenseGain() const {
    const std::vector<int> seen = Seen();
    return prior_.P * H_(seen, Eigen::all).transpose() * S_(seen, seen).inverse();
  }

  static S2kfSettings Settings() {
    S2kfSettings settings;
    settings.filter = FilterType::kEkf;
    settings.update = GetParam();
    settings.iterations = 1;
    return settings;
  }

  KinematicModel model_ = testing::MakeBranchedModel();
  MarkerKinematics kinematics_ = testing::MakeFullKinematics(model_);
  VectorXd scale_ = VectorXd::LinSpaced(kinematics_.num_markers(), 1, 2);
  S2kfSettings settings_ = Settings();
  MarkerFilter filter_{kinematics_, settings_, scale_};
  std::mt19937 random_{3};
  Belief prior_;
  Matrix3Xd z_;
  VectorXd h_;  // dense: z = h + H dx + v, Cov(z - h) = S
  MatrixXd H_;
  MatrixXd S_;
};

TEST_P(UpdateOutcomeTest, ExpectedMarkersAndInnovationCovarianceAreTheDenseOnes) {
  Belief belief = prior_;
  UpdateOutcome outcome = filter_.MakeOutcome();
  filter_.Update(z_, &belief, &outcome);
  EXPECT_EQ(outcome.seen, num_markers() - 2);
  EXPECT_EQ(outcome.downweighted, 0);
  EXPECT_LT((outcome.Expected().reshaped() - h_).norm(), kRounding);
  for (int m = 0; m < num_markers(); ++m) {
    const Eigen::Matrix3d S = S_.block<3, 3>(3 * m, 3 * m);
    EXPECT_LT((outcome.InnovationCovariance(m) - S).norm(), kRounding * S.norm()) << "marker " << m;
    const double deviation = settings_.marker_deviation * scale_[m];
    EXPECT_DOUBLE_EQ(outcome.variance[m], deviation * deviation);
  }
  const std::vector<int> seen = Seen();
  const VectorXd innovation = z_.reshaped()(seen) - h_(seen);
  const double nis = innovation.dot(S_(seen, seen).inverse() * innovation);
  EXPECT_NEAR(outcome.nis, nis / static_cast<double>(seen.size()), kRounding * nis);
}

TEST_P(UpdateOutcomeTest, PosteriorPlacesAndCovarianceAreTheDenseOnes) {
  Belief belief = prior_;
  UpdateOutcome outcome = filter_.MakeOutcome();
  filter_.Update(z_, &belief, &outcome);
  GaussianUpdate::Scratch scratch(kinematics_.num_dofs(), 3 * num_markers());
  const std::vector<int> seen = Seen();
  const MatrixXd K = DenseGain();
  const VectorXd other = h_ + 0.01 * VectorXd::LinSpaced(h_.size(), -1, 1);
  VectorXd places;
  outcome.PosteriorPlaces(other, &scratch, &places);
  const VectorXd expected = h_ + H_ * K * (other - h_)(seen);
  EXPECT_LT((places - expected).norm(), kRounding);
  const MatrixXd P = prior_.P - K * H_(seen, Eigen::all) * prior_.P;
  for (int m = 0; m < num_markers(); ++m) {
    const MatrixXd H = H_.middleRows(3 * m, 3);
    const Eigen::Matrix3d covariance = H * P * H.transpose();
    EXPECT_LT((outcome.PosteriorCovariance(m, &scratch) - covariance).norm(),
              1e-6 * covariance.norm())
        << "marker " << m;
  }
}

TEST_P(UpdateOutcomeTest, WithNothingSeenItIsThePrior) {
  UpdateOutcome outcome = filter_.MakeOutcome();
  Belief belief = prior_;
  filter_.Update(z_, &belief, &outcome);
  belief = prior_;
  const Matrix3Xd none = Matrix3Xd::Constant(3, num_markers(), kNaN);
  filter_.Update(none, &belief, &outcome);
  EXPECT_EQ(outcome.seen, 0);
  EXPECT_EQ(outcome.nis, 0);
  EXPECT_EQ(belief.P, prior_.P);
  EXPECT_LT((outcome.Expected().reshaped() - h_).norm(), kRounding);
  GaussianUpdate::Scratch scratch(kinematics_.num_dofs(), 3 * num_markers());
  VectorXd places;
  outcome.PosteriorPlaces(VectorXd::Ones(h_.size()), &scratch, &places);
  EXPECT_LT((places - h_).norm(), kRounding);
  for (int m = 0; m < num_markers(); ++m) {
    const Eigen::Matrix3d prior = outcome.ExpectedCovariance(m);
    EXPECT_LT((outcome.PosteriorCovariance(m, &scratch) - prior).norm(), kRounding * prior.norm());
  }
}

TEST_P(UpdateOutcomeTest, AMarkerThatIsFarOffHasTheVarianceItCountedWith) {
  z_.col(0) = Eigen::Vector3d(h_.head<3>()) + Eigen::Vector3d(0, 0, 0.3);
  Belief belief = prior_;
  UpdateOutcome outcome = filter_.MakeOutcome();
  filter_.Update(z_, &belief, &outcome);
  EXPECT_EQ(outcome.downweighted, 1);
  const double deviation = settings_.marker_deviation * scale_[0];
  EXPECT_NEAR(outcome.variance[0], 0.3 / settings_.robust_distance * deviation * deviation,
              kRounding * deviation * deviation);
}

INSTANTIATE_TEST_SUITE_P(Forms, UpdateOutcomeTest,
                         ::testing::Values(UpdateForm::kExact, UpdateForm::kRegression));

}  // namespace
}  // namespace mmm_converter::s2kf
