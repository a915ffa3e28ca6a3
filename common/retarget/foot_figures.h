// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/retarget/retarget_figures.h"

namespace mmm_converter {

/// Poses of all segments for each frame.
using PosesOverTime = std::vector<std::vector<Eigen::Isometry3d>>;

inline constexpr double kSlideSpeed = 0.01;  ///< [m/s] above which a foot slides

/// Horizontal way of what bears from one pose of a foot to the next [m].
double WayOf(const RobotFoot& foot, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// Slide, penetration and floating of a robot with feet.
void MeasureFeet(const Retargeted& retargeted, const RobotBody& body, const PosesOverTime& X_WS,
                 RetargetFigures* figures);

}  // namespace mmm_converter
