// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/dynamics_summary.h"

namespace mmm_converter {

/// One self-contained HTML page about the dynamics of a motion: checks, and plots with contacts and
/// flights.
std::string FormatDynamicsPage(const std::string& title, const DynamicsReport& report);

}  // namespace mmm_converter
