// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/math/padded_matrix.h"

namespace mmm_converter::s2kf {

/// Second-order statistics of z = h(x0 + L s) with s ~ N(0, I) of n dimensions: what a Gaussian
/// filter knows of a measurement model.
struct MeasurementMoments {
  /// n states that h depends on, m coordinates of z.
  MeasurementMoments(int n, int m) : mean(m), C_sz(n, m), residual(m) {}

  /// C_zz = 0.
  void ClearCovariance();

  Eigen::VectorXd mean;      ///< E[z], m
  PaddedMatrix C_sz;         ///< Cov(s, z), n x m
  Eigen::VectorXd residual;  ///< diagonal of Cov(z) - C_zs C_sz: what no linear model explains
  PaddedMatrix C_zz;         ///< Cov(z), m x m, lower triangle; the exact form only
};

/// How C_zz enters the gain.
enum class UpdateForm {
  kExact,       ///< K = C_xz (C_zz + R)^-1 [S13]
  kRegression,  ///< z = H x + e with cov(e) kept diagonal; an n x n solve (Woodbury)
};

/// Kalman update in the space of s: x = x0 + L s with the prior s ~ N(0, I) has the posterior mean
/// x0 + L mean() and covariance (L T)(L T)^T. A value; sized once.
class GaussianUpdate {
 public:
  /// n states that h depends on, m measured coordinates.
  GaussianUpdate(int n, int m);

  /// z: measurement, m. noise: variance of each coordinate, m; infinity where z was not measured
  /// (the value of z there is not used). Nothing measured: the posterior is the prior.
  void Compute(const MeasurementMoments& moments, const Eigen::VectorXd& z,
               const Eigen::VectorXd& noise, UpdateForm form);

  UpdateForm form() const { return form_; }
  Eigen::Map<const Eigen::VectorXd> mean() const { return {mean_.data(), mean_.rows()}; }
  /// X = L T. L: as many columns as s is long.
  void Spread(const PaddedMatrix& L, PaddedMatrix* X) const;
  /// Normalised innovation squared, (z - E z)^T (C_zz + R)^-1 (z - E z).
  double nis() const { return nis_; }
  /// Log of the probability density of z, without its constant term.
  double log_likelihood() const { return -0.5 * (nis_ + log_determinant_); }

  /// What the functions below write into; of the same n and m.
  struct Scratch {
    Scratch(int n, int m) : innovation(m, 1), s(n, 1), three(n, 3) {}
    PaddedMatrix innovation;
    PaddedMatrix s;
    PaddedMatrix three;
  };
  /// E[h(x)] had `other` been measured instead of z, with the same noise; moments as in Compute.
  void Expect(const MeasurementMoments& moments, const Eigen::VectorXd& other, Scratch* scratch,
              Eigen::VectorXd* expected) const;
  /// Posterior covariance of h's coordinates i, i + 1, i + 2 in the linear model with this C_sz.
  Eigen::Matrix3d PosteriorCovariance(const PaddedMatrix& C_sz, int i, Scratch* scratch) const;
  /// Cov(s, z) of the linear model whose C_sz in the space of t, s = mean() + T t, is given.
  /// kRegression only. scratch: n x m.
  void FromPosteriorSpace(PaddedMatrix* C_sz, PaddedMatrix* scratch) const;

 private:
  void ComputeRegression(const MeasurementMoments& moments, const Eigen::VectorXd& z,
                         const Eigen::VectorXd& noise);
  void ComputeExact(const MeasurementMoments& moments, const Eigen::VectorXd& z,
                    const Eigen::VectorXd& noise);

  UpdateForm form_ = UpdateForm::kRegression;
  PaddedMatrix mean_;  // n x 1
  double nis_ = 0;
  double log_determinant_ = 0;  // of C_zz + R
  PaddedMatrix weights_;        // m x 1; 0: not measured
  PaddedMatrix innovation_;     // m x 1, scaled
  PaddedMatrix factor_;  // G with T = G^-T (regression) or T itself (exact), lower triangular
  PaddedMatrix F_;       // C_zz + R = F F^T, m x m; exact form
  PaddedMatrix V_;       // C_sz F^-T, n x m; exact form
};

}  // namespace mmm_converter::s2kf
