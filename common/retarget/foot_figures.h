// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/retarget/retarget_figures.h"

namespace mmm_converter {

/// Poses of all segments for each frame.
using PosesOverTime = std::vector<std::vector<Eigen::Isometry3d>>;

/// Slide, penetration and floating of a robot with feet.
void MeasureFeet(const Retargeted& retargeted, const RobotBody& body, const PosesOverTime& X_WS,
                 RetargetFigures* figures);

}  // namespace mmm_converter
