// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/motion/pose_trajectory.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// Covariances as arrays of a .npz file, float64: names (n): root_x, root_y, root_z [m], in the
/// world; root_about_x, root_about_y, root_about_z, about the root's own axes, and the joints
/// [rad]; frame (k), from 0; time (k) [s]; covariance (k, n, n).
/// @throws Error where the file would have 4 GiB or more.
TextPieces FormatCovarianceNpz(const PoseTrajectory& trajectory,
                               const std::vector<PoseCovariance>& covariances);

}  // namespace mmm_converter
