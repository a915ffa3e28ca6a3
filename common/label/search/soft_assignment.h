// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace mmm_converter {

/// Shares of points for markers that are not told apart yet (softassign: Gold and others 1998):
/// exp(-d^2 / (2 variance)), balanced over rows and columns by Sinkhorn's rounds, with a slack for
/// markers without point and points without marker.
class SoftAssignment {
 public:
  /// places: 3 x markers [m]; variances: per marker, each coordinate [m^2]; points: 3 x points [m].
  void Compute(const Eigen::Ref<const Eigen::Matrix3Xd>& places, const Eigen::VectorXd& variances,
               const Eigen::Ref<const Eigen::Matrix3Xd>& points);

  /// The mean of a marker's points by their shares, 3 x markers [m]; NaN where it has next to none.
  const Eigen::Matrix3Xd& targets() const { return targets_; }
  /// The sum of its shares, 0 to 1.
  const Eigen::VectorXd& weights() const { return weights_; }

 private:
  Eigen::MatrixXd shares_;  // points x markers
  Eigen::ArrayXd points_sum_;
  Eigen::Matrix3Xd targets_;
  Eigen::VectorXd weights_;
};

}  // namespace mmm_converter
