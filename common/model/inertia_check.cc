// SPDX-License-Identifier: MIT
#include "common/model/inertia_check.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

namespace mmm_converter {

std::string WhyNoInertia(const Eigen::Matrix3d& inertia) {
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double rounding = 1e-6 * moments.cwiseAbs().maxCoeff();  // files have 6 digits
  if (moments[0] >= -rounding && moments[2] <= moments[0] + moments[1] + rounding) return "";
  return fmt::format(
      "no body has its inertia; each of the three principal moments must be at most the sum of the "
      "other two ({:.4g}, {:.4g} and {:.4g} kg m^2)",
      moments[0], moments[1], moments[2]);
}

}  // namespace mmm_converter
