// SPDX-License-Identifier: MIT
#include "plugins/s2kf/marker_measurement_model.h"

#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "common/math/rotation.h"
#include "plugins/s2kf/lcd_sampling.h"
#include "tests/support/test_models.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using Case = std::tuple<RootParameters, LimitFunction>;

class MarkerMeasurementModelTest : public ::testing::TestWithParam<Case> {
 protected:
  RootParameters root() const { return std::get<0>(GetParam()); }

  Belief RandomBelief(double scale) {
    std::normal_distribution<double> normal(0, scale);
    Belief belief;
    for (double& value : belief.position) value = normal(random_);
    for (double& value : belief.rpy) value = normal(random_);
    belief.orientation = Eigen::Quaterniond(RotationFromRpy(belief.rpy));
    belief.parameters.resize(kinematics_.num_joints());
    for (double& value : belief.parameters) value = normal(random_);
    return belief;
  }

  VectorXd RandomVector(double scale) {
    std::normal_distribution<double> normal(0, scale);
    VectorXd v(kinematics_.num_dofs());
    for (double& value : v) value = normal(random_);
    return v;
  }

  MatrixXd RandomSpread(double scale) {
    const int n = kinematics_.num_dofs();
    MatrixXd spread(n, n);
    for (int i = 0; i < n; ++i) spread.col(i) = RandomVector(scale);
    return spread;
  }

  static PaddedMatrix Padded(const MatrixXd& matrix) {
    PaddedMatrix padded(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()));
    padded.view() = matrix;
    return padded;
  }

  /// The plain definition of h, one state at a time.
  VectorXd Measure(Belief belief, const VectorXd& dx) {
    Move(dx, root(), &belief);
    VectorXd angles(kinematics_.num_joints());
    for (int j = 0; j < angles.size(); ++j) {
      angles[j] = transform_.Angle(j, belief.parameters[j]);
    }
    kinematics_.ComputeMarkers(belief.position, belief.orientation.toRotationMatrix(), angles,
                               &at_);
    return at_.p_WM.reshaped();
  }

  KinematicModel model_ = testing::MakeBranchedModel();
  MarkerKinematics kinematics_ = testing::MakeFullKinematics(model_);
  JointLimitTransform transform_{std::get<1>(GetParam()), kinematics_.lower(), kinematics_.upper()};
  MarkerJacobian at_ = kinematics_.MakeJacobian();
  std::mt19937 random_{7};
};

TEST_P(MarkerMeasurementModelTest, SampledMomentsAreThoseOfAllSamples) {
  const int n = kinematics_.num_dofs();
  const int m = 3 * kinematics_.num_markers();
  // 40 pairs fill five lanes, so that the centre takes a group of its own; 37 do not.
  for (const int pairs : {37, 40}) {
    const MatrixXd half = RandomHalfSamples(n, 2 * pairs + 1, 1);
    MarkerMeasurementModel measurement(kinematics_, transform_, root(), half);
    const Belief belief = RandomBelief(0.5);
    const VectorXd center = RandomVector(0.1);
    const MatrixXd spread = RandomSpread(0.03);
    MeasurementMoments moments(n, m);
    measurement.ComputeMoments(belief, center, {Padded(spread)}, true, &moments);

    MatrixXd samples(n, 2 * pairs + 1);
    samples << half, -half, VectorXd::Zero(n);
    MatrixXd z(m, samples.cols());
    for (Eigen::Index i = 0; i < samples.cols(); ++i) {
      z.col(i) = Measure(belief, center + spread * samples.col(i));
    }
    const VectorXd mean = z.rowwise().mean();
    const MatrixXd difference = z.colwise() - mean;
    const double weight = 1.0 / static_cast<double>(samples.cols());
    const MatrixXd C_zz = weight * difference * difference.transpose();
    const MatrixXd C_zs = weight * difference * samples.transpose();
    const VectorXd residual = (C_zz - C_zs * C_zs.transpose()).diagonal();
    // Sums of 81 terms below 1, in another order.
    constexpr double kRounding = 1e-13;
    EXPECT_LT((moments.mean - mean).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT((moments.C_sz.view() - C_zs.transpose()).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT((moments.residual - residual).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LT((MatrixXd(moments.C_zz.view().selfadjointView<Eigen::Lower>()) - C_zz)
                  .cwiseAbs()
                  .maxCoeff(),
              kRounding);

    MeasurementMoments without(n, m);
    measurement.ComputeMoments(belief, center, {Padded(spread)}, false, &without);
    EXPECT_EQ(without.mean, moments.mean);
    EXPECT_EQ(without.C_sz.view(), moments.C_sz.view());
    EXPECT_EQ(without.residual, moments.residual);
    EXPECT_EQ(without.C_zz.rows(), 0);
  }
}

TEST_P(MarkerMeasurementModelTest, LinearizedMomentsMatchFiniteDifferences) {
  const int n = kinematics_.num_dofs();
  MarkerMeasurementModel measurement(kinematics_, transform_, root(), MatrixXd(n, 0));
  MeasurementMoments moments(n, 3 * kinematics_.num_markers());
  for (const double scale : {0.0, 1e-8, 0.7}) {
    const Belief belief = RandomBelief(scale);
    const VectorXd center = RandomVector(scale);
    measurement.ComputeMoments(belief, center, {Padded(MatrixXd::Identity(n, n))}, false, &moments);
    EXPECT_LT((moments.mean - Measure(belief, center)).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_EQ(moments.residual.norm(), 0);
    for (int i = 0; i < n; ++i) {
      // Central differences: h^2 / 6 = 2e-11 and rounding 1e-16 / h = 1e-11, times lengths below 1
      // m.
      const double h = 1e-5;
      const VectorXd step = h * VectorXd::Unit(n, i);
      const VectorXd column =
          (Measure(belief, center + step) - Measure(belief, center - step)) / (2 * h);
      EXPECT_LT((moments.C_sz.view().row(i).transpose() - column).cwiseAbs().maxCoeff(), 1e-9)
          << "scale " << scale << ", column " << i;
    }
  }
}

TEST_P(MarkerMeasurementModelTest, SamplesOfATinySpreadAreTheLinearization) {
  const int n = kinematics_.num_dofs();
  const int m = 3 * kinematics_.num_markers();
  MarkerMeasurementModel sampled(kinematics_, transform_, root(), RotatedUkfHalfSamples(n, 1));
  MarkerMeasurementModel linearized(kinematics_, transform_, root(), MatrixXd(n, 0));
  const Belief belief = RandomBelief(0.5);
  const MatrixXd spread = RandomSpread(1e-5);
  MeasurementMoments a(n, m);
  MeasurementMoments b(n, m);
  sampled.ComputeMoments(belief, VectorXd::Zero(n), {Padded(spread)}, false, &a);
  linearized.ComputeMoments(belief, VectorXd::Zero(n), {Padded(spread)}, false, &b);
  // Third order in 1e-5 for C_zs, second order for the mean.
  EXPECT_LT((a.C_sz.view() - b.C_sz.view()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((a.mean - b.mean).cwiseAbs().maxCoeff(), 1e-8);

  linearized.ComputeMoments(belief, VectorXd::Zero(n), {Padded(spread)}, true, &b);
  // Entries of about 1e-10, in another order of summation.
  const MatrixXd C_zs = b.C_sz.view().transpose();
  EXPECT_LT(
      (MatrixXd(b.C_zz.view().selfadjointView<Eigen::Lower>()) - C_zs * C_zs.transpose()).norm(),
      1e-22);
}

TEST_P(MarkerMeasurementModelTest, ATriangularSpreadIsOnlyFaster) {
  // With two joints the states fill one group of rows, with all of them several.
  const MarkerKinematics small(model_, {0, 1}, kinematics_.markers());
  const MarkerKinematics* both[] = {&small, &kinematics_};
  for (const MarkerKinematics* kinematics : both) {
    const int n = kinematics->num_dofs();
    const int m = 3 * kinematics->num_markers();
    const JointLimitTransform transform(transform_.function(), kinematics->lower(),
                                        kinematics->upper());
    Belief belief = RandomBelief(0.5);
    belief.parameters.conservativeResize(n - 6);
    const VectorXd center = RandomVector(0.1).head(n);
    MatrixXd spread = RandomSpread(0.03).topLeftCorner(n, n);
    spread.triangularView<Eigen::StrictlyUpper>().setZero();
    for (const MatrixXd& half : {RandomHalfSamples(n, 41, 1), MatrixXd(n, 0)}) {
      MarkerMeasurementModel measurement(*kinematics, transform, root(), half);
      MeasurementMoments full(n, m);
      MeasurementMoments lower(n, m);
      measurement.ComputeMoments(belief, center, {Padded(spread)}, false, &full);
      measurement.ComputeMoments(belief, center, {Padded(spread), true}, false, &lower);
      EXPECT_EQ(lower.mean, full.mean);
      EXPECT_EQ(lower.C_sz.view(), full.C_sz.view());
      EXPECT_EQ(lower.residual, full.residual);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, MarkerMeasurementModelTest,
    ::testing::Combine(::testing::Values(RootParameters::kSo3, RootParameters::kRpy),
                       ::testing::Values(LimitFunction::kSine, LimitFunction::kTanh)));

}  // namespace
}  // namespace mmm_converter::s2kf
