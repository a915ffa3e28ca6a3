// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/io/mmm/mmm_motion.h"

namespace mmm_converter::testing {

/// How far two trajectories are apart once the constant transform between them is taken out.
struct Deviation {
  double millimetres = 0;  ///< root mean square
  double degrees = 0;      ///< root mean square
};

Deviation DeviationOf(const std::vector<Eigen::Isometry3d>& ours,
                      const std::vector<Eigen::Isometry3d>& stored);

std::vector<Eigen::Isometry3d> PosesOf(const MmmMotion& motion);

/// The motion of that name. @throws std::runtime_error where there is none.
const MmmMotion& FindMotion(const MmmMotionFile& file, const std::string& name);

}  // namespace mmm_converter::testing
