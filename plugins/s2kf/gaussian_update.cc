// SPDX-License-Identifier: MIT
#include "plugins/s2kf/gaussian_update.h"

#include <cmath>

namespace mmm_converter::s2kf {

using Eigen::MatrixXd;
using Eigen::VectorXd;

GaussianUpdate::GaussianUpdate(int n, int m)
    : mean_(n),
      root_(n, n),
      scaled_(m, n),
      innovation_(m),
      information_(n, n),
      information_llt_(n) {}

void GaussianUpdate::Compute(const MeasurementMoments& moments, const VectorXd& z,
                             const VectorXd& noise, UpdateForm form) {
  if (form == UpdateForm::kRegression) {
    ComputeRegression(moments, z, noise);
  } else {
    ComputeExact(moments, z, noise);
  }
}

void GaussianUpdate::ComputeRegression(const MeasurementMoments& moments, const VectorXd& z,
                                       const VectorXd& noise) {
  // Rows scaled by the standard deviation of noise and residual: information = I + A^T A.
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double weight = std::isinf(noise[i]) ? 0 : 1 / std::sqrt(noise[i] + moments.residual[i]);
    scaled_.row(i) = weight * moments.C_zs.row(i);
    innovation_[i] = weight > 0 ? weight * (z[i] - moments.mean[i]) : 0;
  }
  information_.setIdentity();
  information_.selfadjointView<Eigen::Lower>().rankUpdate(scaled_.transpose());
  information_llt_.compute(information_);
  mean_.noalias() = scaled_.transpose() * innovation_;
  information_llt_.matrixL().solveInPlace(mean_);
  nis_ = innovation_.squaredNorm() - mean_.squaredNorm();
  information_llt_.matrixU().solveInPlace(mean_);
  // information = G G^T, so its inverse is (G^-1)^T G^-1.
  root_.setIdentity();
  information_llt_.matrixL().solveInPlace(root_);
}

void GaussianUpdate::ComputeExact(const MeasurementMoments& moments, const VectorXd& z,
                                  const VectorXd& noise) {
  const Eigen::Index m = z.size();
  S_.resize(m, m);
  S_.triangularView<Eigen::Lower>() = moments.C_zz;
  scaled_ = moments.C_zs;
  for (Eigen::Index i = 0; i < m; ++i) {
    if (std::isinf(noise[i])) {
      // An unmeasured coordinate: independent of everything, with innovation 0.
      S_.row(i).head(i).setZero();
      S_.col(i).tail(m - i - 1).setZero();
      S_(i, i) = 1;
      scaled_.row(i).setZero();
      innovation_[i] = 0;
    } else {
      S_(i, i) += noise[i];
      innovation_[i] = z[i] - moments.mean[i];
    }
  }
  S_llt_.compute(S_);
  S_llt_.matrixL().solveInPlace(scaled_);
  S_llt_.matrixL().solveInPlace(innovation_);
  nis_ = innovation_.squaredNorm();
  mean_.noalias() = scaled_.transpose() * innovation_;
  // Cov(s | z) = I - V^T V = M M^T with V = S^(-1/2) C_zs.
  information_.setIdentity();
  information_.selfadjointView<Eigen::Lower>().rankUpdate(scaled_.transpose(), -1.0);
  information_llt_.compute(information_);
  root_ = information_llt_.matrixU();
}

}  // namespace mmm_converter::s2kf
