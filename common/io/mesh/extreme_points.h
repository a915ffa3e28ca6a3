// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmm_converter {

/// The points that are farthest in some direction, of directions 5 degrees apart: no point is
/// beyond the hull of these by more than a thousandth of the size of what they bound.
std::vector<Eigen::Vector3d> ExtremePoints(const Eigen::Matrix3Xd& points);

}  // namespace mmm_converter
