// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/tables/marker_rows.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// True if text can be an ASCII export of Vicon Nexus: a section's name ("Trajectories", "Devices",
/// "Model Outputs", ...), in the next line its rate.
bool LooksLikeNexusCsv(std::string_view content);

/// The trajectories of an ASCII export of Vicon Nexus. Sections follow each other, blank lines
/// between them:
///
///     Trajectories
///     100
///     ,,Ann:LASI,,,Ann:RASI,,
///     Frame,Sub Frame,X,Y,Z,X,Y,Z
///     ,,mm,mm,mm,mm,mm,mm
///     1,0,12.3,...
///
/// Frames count from 1 at 0 s. Semicolons or tabs may separate.
/// @throws Error where there are no trajectories, and as ReadMarkerRows.
MarkerTable ParseNexusCsv(std::string_view content, const std::string& file,
                          Warnings* warnings = nullptr);

}  // namespace mmm_converter
