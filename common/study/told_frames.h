// SPDX-License-Identifier: MIT
// What the judges of labels' places have in common.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"

namespace mmm_converter {

/// Of each coordinate of a label's place [m]: noise scale 1.
inline constexpr double kPlaceDeviation = 0.028;

/// Some frames of so many, spread evenly.
std::vector<int> LookedAt(int num_frames);

/// What is known of a posture before its markers are seen, by degree of freedom [1/rad^2],
/// [1/m^2]: the root is anywhere, and a joint at a limit follows no label beyond it.
Eigen::VectorXd PostureInformation(const MarkerKinematics& kinematics, const Posture& posture);

}  // namespace mmm_converter
