// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/dynamics/motion_dynamics.h"

namespace mmm_converter {

/// The intervals of at least `shortest` seconds in which no contact body is lower than kRestHeight,
/// from a MotionDynamics that is else complete. measured_com: 3 x frames, of the motion as it is,
/// without a low-pass [m]: the parabola is a filter that suits a flight better.
std::vector<BallisticPhase> FindBallisticPhases(const MotionDynamics& dynamics,
                                                const Eigen::Matrix3Xd& measured_com,
                                                double shortest);

}  // namespace mmm_converter
