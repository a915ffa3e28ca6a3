// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/angles/gait.h"

namespace mmm_converter {

/// The strides of one recording.
struct GaitTrial {
  std::string name;
  const Gait* gait = nullptr;
};

/// Of a force, moment or power by the name that Gait::forces have for it: "N m/kg".
const char* ForceUnitOf(std::string_view motion);

/// Angles, forces, moments and powers over the gait cycle, a row for each of these, side and
/// percent: trial, joint, side (whose strides), angle (or "extension moment", "power"), unit,
/// percent, mean, sd (among the strides), uncertainty (of the angle itself), strides. Empty: not
/// known. Turns of pelvis, trunk and neck to a side have the sign of the side (OwnSideSign).
std::string FormatGaitCsv(const std::vector<GaitTrial>& trials);

/// All strides, their means and deviations of each side, and angles in degrees, forces, moments and
/// powers over the cycle. Of several: a list "trials" of these.
std::string FormatGaitJson(const std::vector<GaitTrial>& trials);

}  // namespace mmm_converter
