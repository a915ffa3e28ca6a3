// SPDX-License-Identifier: MIT
#include "plugins/s2kf/gaussian_update.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>
#include <random>

namespace mmm_converter::s2kf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Solves of well-conditioned systems of size below 10.
constexpr double kUpdateRounding = 1e-12;

/// A linear measurement z = H x + v of x ~ N(x0, P), and the textbook Kalman update of it.
struct LinearProblem {
  explicit LinearProblem(int n, int m) {
    std::srand(1);
    const MatrixXd A = MatrixXd::Random(n, n);
    P = A * A.transpose() + 0.1 * MatrixXd::Identity(n, n);
    L = P.llt().matrixL();
    x0 = VectorXd::Random(n);
    H = MatrixXd::Random(m, n);
    z = VectorXd::Random(m);
    noise = (VectorXd::Random(m).array() + 1.5).matrix() * 0.1;
  }

  MeasurementMoments Moments() const {
    MeasurementMoments moments(static_cast<int>(x0.size()), static_cast<int>(z.size()));
    moments.mean = H * x0;
    moments.C_sz.view() = (H * L).transpose();
    moments.residual.setZero(z.size());
    moments.ClearCovariance();
    moments.C_zz.view() = H * P * H.transpose();
    return moments;
  }

  void Textbook(VectorXd* x, MatrixXd* P_after, double* nis) const {
    const MatrixXd S = H * P * H.transpose() + MatrixXd(noise.asDiagonal());
    const MatrixXd K = P * H.transpose() * S.inverse();
    *x = x0 + K * (z - H * x0);
    *P_after = P - K * H * P;
    *nis = (z - H * x0).dot(S.inverse() * (z - H * x0));
  }

  VectorXd x0, z, noise;
  MatrixXd P, L, H;
};

/// L T of the posterior.
MatrixXd Spread(const GaussianUpdate& update, const MatrixXd& L) {
  PaddedMatrix padded(static_cast<int>(L.rows()), static_cast<int>(L.cols()));
  padded.view() = L;
  PaddedMatrix result(padded.rows(), padded.cols());
  update.Spread(padded, &result);
  return result.view();
}

class GaussianUpdateTest : public ::testing::TestWithParam<UpdateForm> {};

TEST_P(GaussianUpdateTest, IsTheKalmanFilterOnALinearModel) {
  const LinearProblem problem(5, 8);
  GaussianUpdate update(5, 8);
  update.Compute(problem.Moments(), problem.z, problem.noise, GetParam());
  VectorXd x;
  MatrixXd P;
  double nis = 0;
  problem.Textbook(&x, &P, &nis);
  const MatrixXd T = Spread(update, problem.L);
  EXPECT_LT((problem.x0 + problem.L * update.mean() - x).norm(), kUpdateRounding);
  EXPECT_LT((T * T.transpose() - P).norm(), kUpdateRounding);
  EXPECT_NEAR(update.nis(), nis, kUpdateRounding * nis);
}

TEST_P(GaussianUpdateTest, ACoordinateThatWasNotMeasuredIsLeftOut) {
  LinearProblem problem(4, 6);
  GaussianUpdate all(4, 6);
  VectorXd noise = problem.noise;
  noise[2] = std::numeric_limits<double>::infinity();
  VectorXd z = problem.z;
  z[2] = 1e30;
  all.Compute(problem.Moments(), z, noise, GetParam());

  const std::vector<int> kept = {0, 1, 3, 4, 5};
  problem.H = MatrixXd(problem.H(kept, Eigen::all));
  problem.z = VectorXd(problem.z(kept));
  problem.noise = VectorXd(problem.noise(kept));
  GaussianUpdate fewer(4, 5);
  fewer.Compute(problem.Moments(), problem.z, problem.noise, GetParam());
  EXPECT_LT((all.mean() - fewer.mean()).norm(), kUpdateRounding);
  const MatrixXd T = Spread(all, MatrixXd::Identity(4, 4));
  const MatrixXd U = Spread(fewer, MatrixXd::Identity(4, 4));
  EXPECT_LT((T * T.transpose() - U * U.transpose()).norm(), kUpdateRounding);
  EXPECT_NEAR(all.nis(), fewer.nis(), kUpdateRounding * fewer.nis());
}

TEST_P(GaussianUpdateTest, NothingMeasuredChangesNothing) {
  const LinearProblem problem(3, 4);
  GaussianUpdate update(3, 4);
  update.Compute(problem.Moments(), problem.z,
                 VectorXd::Constant(4, std::numeric_limits<double>::infinity()), GetParam());
  EXPECT_EQ(update.mean(), VectorXd::Zero(3));
  EXPECT_EQ(Spread(update, MatrixXd::Identity(3, 3)), MatrixXd::Identity(3, 3));
}

TEST_P(GaussianUpdateTest, WithNothingMeasuredExpectsThePrior) {
  const LinearProblem problem(3, 6);
  const MeasurementMoments moments = problem.Moments();
  GaussianUpdate update(3, 6);
  // An update before leaves nothing.
  update.Compute(moments, problem.z, problem.noise, GetParam());
  update.Compute(moments, problem.z, VectorXd::Constant(6, std::numeric_limits<double>::infinity()),
                 GetParam());
  GaussianUpdate::Scratch scratch(3, 6);
  VectorXd expected;
  update.Expect(moments, VectorXd::Ones(6), &scratch, &expected);
  EXPECT_EQ(expected, moments.mean);
  const MatrixXd prior = (problem.H * problem.P * problem.H.transpose()).block(3, 3, 3, 3);
  EXPECT_LT((update.PosteriorCovariance(moments.C_sz, 3, &scratch) - prior).norm(),
            kUpdateRounding);
  EXPECT_EQ(update.nis(), 0);
}

TEST_P(GaussianUpdateTest, NumbersThatAreNotFiniteAreForgotten) {
  const LinearProblem problem(5, 8);
  GaussianUpdate fresh(5, 8);
  fresh.Compute(problem.Moments(), problem.z, problem.noise, GetParam());
  GaussianUpdate update(5, 8);
  MeasurementMoments broken = problem.Moments();
  broken.C_sz.view().setConstant(std::numeric_limits<double>::quiet_NaN());
  update.Compute(broken, problem.z, problem.noise, GetParam());
  EXPECT_TRUE(update.mean().hasNaN());
  update.Compute(problem.Moments(), problem.z, problem.noise, GetParam());
  EXPECT_EQ(update.mean(), fresh.mean());
  EXPECT_EQ(Spread(update, problem.L), Spread(fresh, problem.L));
}

TEST_P(GaussianUpdateTest, ExpectsWhatAnotherMeasurementWouldHaveGiven) {
  LinearProblem problem(5, 8);
  GaussianUpdate update(5, 8);
  MeasurementMoments moments = problem.Moments();
  update.Compute(moments, problem.z, problem.noise, GetParam());
  problem.z = VectorXd::LinSpaced(8, -2, 2);
  VectorXd x;
  MatrixXd P;
  double nis = 0;
  problem.Textbook(&x, &P, &nis);
  VectorXd expected;
  GaussianUpdate::Scratch scratch(5, 8);
  update.Expect(moments, problem.z, &scratch, &expected);
  EXPECT_LT((expected - problem.H * x).norm(), kUpdateRounding);
  const MatrixXd covariance = (problem.H * P * problem.H.transpose()).block(3, 3, 3, 3);
  EXPECT_LT((update.PosteriorCovariance(moments.C_sz, 3, &scratch) - covariance).norm(),
            kUpdateRounding);
}

TEST(GaussianUpdateFormsTest, AgreeWhereTheResidualIsDiagonal) {
  const LinearProblem problem(5, 8);
  MeasurementMoments moments = problem.Moments();
  moments.residual = VectorXd::LinSpaced(8, 0.01, 0.2);
  moments.C_zz.view() += MatrixXd(moments.residual.asDiagonal());
  GaussianUpdate exact(5, 8);
  GaussianUpdate regression(5, 8);
  exact.Compute(moments, problem.z, problem.noise, UpdateForm::kExact);
  regression.Compute(moments, problem.z, problem.noise, UpdateForm::kRegression);
  EXPECT_LT((exact.mean() - regression.mean()).norm(), kUpdateRounding);
  EXPECT_NEAR(exact.nis(), regression.nis(), kUpdateRounding * exact.nis());
}

INSTANTIATE_TEST_SUITE_P(Forms, GaussianUpdateTest,
                         ::testing::Values(UpdateForm::kExact, UpdateForm::kRegression));

}  // namespace
}  // namespace mmm_converter::s2kf
