// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/angles/gait.h"

namespace mmm_converter {

/// Angles over the gait cycle, a row for each angle, side and percent: joint, side (whose strides),
/// angle, percent, mean_degrees, sd_degrees (among the strides), uncertainty_degrees (of the angle
/// itself), strides. Empty: not known.
std::string FormatGaitCsv(const Gait& gait);

/// All strides, their means and deviations of each side, and the angles over the cycle, in degrees.
std::string FormatGaitJson(const Gait& gait);

}  // namespace mmm_converter
