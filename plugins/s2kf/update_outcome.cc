// SPDX-License-Identifier: MIT
#include "plugins/s2kf/update_outcome.h"

namespace mmm_converter::s2kf {

using Eigen::Matrix3d;

UpdateOutcome::UpdateOutcome(int num_dofs, int num_markers)
    : variance(Eigen::VectorXd::Zero(num_markers)),
      moments(num_dofs, 3 * num_markers),
      update(num_dofs, 3 * num_markers) {}

Eigen::Map<const Eigen::Matrix3Xd> UpdateOutcome::Expected() const {
  return {moments.mean.data(), 3, moments.mean.size() / 3};
}

Matrix3d UpdateOutcome::ExpectedCovariance(int marker) const {
  const int i = 3 * marker;
  if (update.form() == UpdateForm::kExact) {
    const Matrix3d lower = moments.C_zz.view().block<3, 3>(i, i);
    return lower.selfadjointView<Eigen::Lower>();
  }
  const auto C = moments.C_sz.view().middleCols<3>(i);
  Matrix3d covariance = C.transpose().lazyProduct(C);
  covariance.diagonal() += moments.residual.segment<3>(i);
  return covariance;
}

Matrix3d UpdateOutcome::InnovationCovariance(int marker) const {
  Matrix3d covariance = ExpectedCovariance(marker);
  covariance.diagonal().array() += variance[marker];
  return covariance;
}

}  // namespace mmm_converter::s2kf
