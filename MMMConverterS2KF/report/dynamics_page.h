// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/dynamics/plausibility.h"
#include "common/dynamics/motion_dynamics.h"

namespace mmm_converter {

/// One self-contained HTML page about the dynamics of a motion: checks, and plots with contacts and
/// flights. figures: the JSON of FormatDynamicsJson.
std::string FormatDynamicsPage(const std::string& title, const std::string& figures,
                               const MotionDynamics& dynamics, const Plausibility& judged);

}  // namespace mmm_converter
