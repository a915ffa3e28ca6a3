// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace mmm_converter::s2kf {

/// Modified Cramer-von Mises distance D = D1 - 2 D2 + D3 between the standard normal in n
/// dimensions and point-symmetric samples of equal weight (Steinbring, Pander, Hanebeck 2016;
/// kernel widths b up to 5, 10, 50, 100 for n up to 1, 10, 100, 1000).
class LcdDistance {
 public:
  explicit LcdDistance(int dimension);

  /// D of the samples 0, +s_i, -s_i with s_i the columns of half_samples (n x K).
  /// gradient: dD/ds_i, n x K; may be null.
  double Evaluate(const Eigen::MatrixXd& half_samples, Eigen::MatrixXd* gradient) const;

 private:
  int dimension_;
  double max_width_;       // B
  Eigen::ArrayXd decay_;   // quadrature nodes b as 1 / (2 (1 + 2 b^2))
  Eigen::ArrayXd weight_;  // quadrature weight * b (2 b^2 / (1 + 2 b^2))^(n/2)
  double d1_;
};

}  // namespace mmm_converter::s2kf
