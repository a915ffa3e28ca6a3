// SPDX-License-Identifier: MIT
#pragma once

#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// Sets velocities and accelerations to the central differences of the postures, which are exact
/// where the acceleration is constant; at both ends those of the nearest inner frame go on. Two
/// frames have no acceleration, one frame has no velocity (0). For postures that are smooth:
/// differences of framewise fits are mostly noise.
void Differentiate(PoseTrajectory* trajectory);

}  // namespace mmm_converter
