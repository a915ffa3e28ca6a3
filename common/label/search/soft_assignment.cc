// SPDX-License-Identifier: MIT
#include "common/label/search/soft_assignment.h"

#include <cmath>

#include "common/label/tuning.h"
#include "common/support/units.h"

namespace mmm_converter {

void SoftAssignment::Compute(const Eigen::Ref<const Eigen::Matrix3Xd>& places,
                             const Eigen::VectorXd& variances,
                             const Eigen::Ref<const Eigen::Matrix3Xd>& points) {
  const Eigen::Index markers = places.cols();
  shares_.resize(points.cols(), markers);
  for (Eigen::Index m = 0; m < markers; ++m) {
    const Eigen::Vector3d place = places.col(m);
    shares_.col(m) = (points.colwise() - place).colwise().squaredNorm().transpose();
    const double scale = -0.5 / variances[m];
    for (double& share : shares_.col(m)) {
      const double exponent = scale * share;
      share = exponent < SoftTuning::kLeastExponent ? 0 : std::exp(exponent);
    }
  }
  for (int round = 0; round < SoftTuning::kRounds; ++round) {
    for (Eigen::Index m = 0; m < markers; ++m)
      shares_.col(m) /= SoftTuning::kSlack + shares_.col(m).sum();
    points_sum_ = shares_.rowwise().sum().array() + SoftTuning::kSlack;
    shares_.array().colwise() /= points_sum_;
  }
  weights_ = shares_.colwise().sum().transpose();
  targets_.noalias() = points * shares_;
  for (Eigen::Index m = 0; m < markers; ++m) {
    if (weights_[m] > SoftTuning::kLeastWeight) {
      targets_.col(m) /= weights_[m];
    } else {
      targets_.col(m).setConstant(kNaN);
    }
  }
}

}  // namespace mmm_converter
