// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace mmm_converter::s2kf {

/// Second-order statistics of z = h(x0 + L s) with s ~ N(0, I) of n dimensions: what a Gaussian
/// filter knows of a measurement model. Coordinates that were not measured have variance_of_noise =
/// infinity.
struct MeasurementMoments {
  /// n states that h depends on, m coordinates of z.
  MeasurementMoments(int n, int m) : mean(m), C_zs(m, n), residual(m) {}

  Eigen::VectorXd mean;      ///< E[z], m
  Eigen::MatrixXd C_zs;      ///< Cov(z, s), m x n
  Eigen::VectorXd residual;  ///< diagonal of Cov(z) - C_zs C_zs^T: what no linear model explains
  Eigen::MatrixXd C_zz;      ///< Cov(z), m x m; the exact form only
};

/// How C_zz enters the gain.
enum class UpdateForm {
  kExact,       ///< K = C_xz (C_zz + R)^-1 [S13]
  kRegression,  ///< z = H x + e with cov(e) kept diagonal; an n x n solve (Woodbury)
};

/// Kalman update in the space of s: x = x0 + L s with the prior s ~ N(0, I). The posterior of x is
/// x0 + L mean(), with covariance L root()^T root() L^T. Sized once.
class GaussianUpdate {
 public:
  /// n states that h depends on, m measured coordinates.
  GaussianUpdate(int n, int m);

  /// z: measurement, m. noise: variance of each coordinate, m; infinity where z was not measured
  /// (the value of z there is not used).
  void Compute(const MeasurementMoments& moments, const Eigen::VectorXd& z,
               const Eigen::VectorXd& noise, UpdateForm form);

  const Eigen::VectorXd& mean() const { return mean_; }
  const Eigen::MatrixXd& root() const { return root_; }  ///< upper or lower triangular, n x n
  /// Normalised innovation squared, (z - E z)^T (C_zz + R)^-1 (z - E z).
  double nis() const { return nis_; }

 private:
  void ComputeRegression(const MeasurementMoments& moments, const Eigen::VectorXd& z,
                         const Eigen::VectorXd& noise);
  void ComputeExact(const MeasurementMoments& moments, const Eigen::VectorXd& z,
                    const Eigen::VectorXd& noise);

  Eigen::VectorXd mean_;
  Eigen::MatrixXd root_;
  double nis_ = 0;
  Eigen::MatrixXd scaled_;       // m x n
  Eigen::VectorXd innovation_;   // m
  Eigen::MatrixXd information_;  // n x n
  Eigen::LLT<Eigen::MatrixXd> information_llt_;
  Eigen::MatrixXd S_;  // m x m, exact form
  Eigen::LLT<Eigen::MatrixXd> S_llt_;
};

}  // namespace mmm_converter::s2kf
