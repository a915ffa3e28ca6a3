// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/pipeline/dynamics/retarget_run.h"

namespace mmm_converter {

/// One self-contained HTML page about a motion on a robot: a player with the person and the robot,
/// their limbs coloured by the map, also at their zero poses; contacts, charts, figures, and what
/// the robot could not do.
std::string FormatRetargetPage(const RetargetReport& report);

}  // namespace mmm_converter
