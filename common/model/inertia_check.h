// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

namespace mmm_converter {

/// What is wrong with a matrix of inertia about a body's centre of mass [kg m^2]; empty: nothing.
std::string WhyNoInertia(const Eigen::Matrix3d& inertia);

}  // namespace mmm_converter
