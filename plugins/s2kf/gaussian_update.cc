// SPDX-License-Identifier: MIT
#include "plugins/s2kf/gaussian_update.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "common/math/dense.h"

namespace mmm_converter::s2kf {

using Eigen::VectorXd;

void MeasurementMoments::ClearCovariance() {
  const int m = static_cast<int>(mean.size());
  if (C_zz.rows() == 0) C_zz = PaddedMatrix(m, m);
  C_zz.SetZero();
}

GaussianUpdate::GaussianUpdate(int n, int m)
    : mean_(n, 1), weights_(m, 1), innovation_(m, 1), factor_(n, n) {}

void GaussianUpdate::Compute(const MeasurementMoments& moments, const VectorXd& z,
                             const VectorXd& noise, UpdateForm form) {
  form_ = form;
  if (form == UpdateForm::kRegression) {
    ComputeRegression(moments, z, noise);
  } else {
    ComputeExact(moments, z, noise);
  }
}

void GaussianUpdate::ComputeRegression(const MeasurementMoments& moments, const VectorXd& z,
                                       const VectorXd& noise) {
  auto weights = weights_.view().col(0);
  auto innovation = innovation_.view().col(0);
  double squares = 0;
  log_determinant_ = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const bool is_measured = !std::isinf(noise[i]);
    weights[i] = is_measured ? 1 / (noise[i] + moments.residual[i]) : 0;
    const double difference = is_measured ? z[i] - moments.mean[i] : 0;
    innovation[i] = weights[i] * difference;
    squares += innovation[i] * difference;
    if (is_measured) log_determinant_ -= std::log(weights[i]);
  }
  // information = I + C_sz W C_zs = G G^T, so the covariance is G^-T G^-1.
  factor_.SetIdentity();
  AddWeightedSquare(moments.C_sz, weights_, &factor_);
  Factorize(&factor_);
  // det(C_zz + R) = det(information) / det W (matrix determinant lemma).
  log_determinant_ += 2 * factor_.view().diagonal().array().log().sum();
  mean_.SetZero();
  mean_.view().col(0).noalias() = moments.C_sz.view() * innovation;
  SolveLower(factor_, &mean_);
  nis_ = squares - mean_.view().squaredNorm();
  SolveLowerTransposed(factor_, &mean_);
}

void GaussianUpdate::ComputeExact(const MeasurementMoments& moments, const VectorXd& z,
                                  const VectorXd& noise) {
  const Eigen::Index m = z.size();
  F_ = moments.C_zz;
  V_ = moments.C_sz;
  auto S = F_.view();
  auto innovation = innovation_.view().col(0);
  for (Eigen::Index i = 0; i < m; ++i) {
    weights_.view()(i, 0) = std::isinf(noise[i]) ? 0 : 1;
    if (std::isinf(noise[i])) {
      // An unmeasured coordinate: independent of everything, with innovation 0.
      S.row(i).head(i).setZero();
      S.col(i).tail(m - i - 1).setZero();
      S(i, i) = 1;
      V_.view().col(i).setZero();
      innovation[i] = 0;
    } else {
      S(i, i) += noise[i];
      innovation[i] = z[i] - moments.mean[i];
    }
  }
  // The gain is V F^-1, and Cov(s | z) = I - V V^T.
  Factorize(&F_);
  log_determinant_ = 2 * F_.view().diagonal().array().log().sum();
  DivideByTransposed(F_, &V_);
  SolveLower(F_, &innovation_);
  nis_ = innovation.squaredNorm();
  mean_.SetZero();
  mean_.view().col(0).noalias() = V_.view() * innovation;
  factor_.SetIdentity();
  AddSquare(-1, V_, &factor_);
  Factorize(&factor_);
}

void GaussianUpdate::Spread(const PaddedMatrix& L, PaddedMatrix* X) const {
  if (form_ == UpdateForm::kRegression) {
    *X = L;
    DivideByTransposed(factor_, X);
  } else {
    Multiply(1, L, factor_, X);
  }
}

void GaussianUpdate::Expect(const MeasurementMoments& moments, const VectorXd& other,
                            Scratch* scratch, VectorXd* expected) const {
  auto innovation = scratch->innovation.view().col(0);
  for (Eigen::Index i = 0; i < other.size(); ++i) {
    innovation[i] = weights_.view()(i, 0) == 0 ? 0 : other[i] - moments.mean[i];
  }
  scratch->s.SetZero();
  auto s = scratch->s.view().col(0);
  if (form_ == UpdateForm::kRegression) {
    innovation.array() *= weights_.view().col(0).array();
    s.noalias() = moments.C_sz.view() * innovation;
    SolveLower(factor_, &scratch->s);
    SolveLowerTransposed(factor_, &scratch->s);
  } else {
    SolveLower(F_, &scratch->innovation);
    s.noalias() = V_.view() * innovation;
  }
  *expected = moments.mean;
  *expected += moments.C_sz.view().transpose().lazyProduct(s);
}

Eigen::Matrix3d GaussianUpdate::PosteriorCovariance(const PaddedMatrix& C_sz, int i,
                                                    Scratch* scratch) const {
  const auto C = C_sz.view().middleCols<3>(i);
  auto V = scratch->three.view();
  if (form_ == UpdateForm::kRegression) {
    V = C;
    factor_.view().triangularView<Eigen::Lower>().solveInPlace(V);
  } else {
    V = factor_.view().transpose().lazyProduct(C);
  }
  return V.transpose().lazyProduct(V);
}

void GaussianUpdate::FromPosteriorSpace(PaddedMatrix* C_sz, PaddedMatrix* scratch) const {
  // C_sz = T^-T C_tz.
  assert(form_ == UpdateForm::kRegression);
  Multiply(1, factor_, *C_sz, scratch);
  std::swap(*C_sz, *scratch);
}

}  // namespace mmm_converter::s2kf
