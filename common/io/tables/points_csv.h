// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/tables/marker_rows.h"

namespace mmm_converter {

/// By its first lines: most columns are the coordinates of points, "LASI_x, LASI_y, LASI_z", or
/// names over "x, y, z".
bool LooksLikePointsCsv(std::string_view content);

/// Tables that programs for data write, a row for each frame: names of points with their
/// coordinates in one or two header rows ("LASI_x", "LASI.X (mm)", "LASI[0]"), separated by commas,
/// semicolons or tabs; a column of time or of frame numbers where there is one, and other columns,
/// which are passed over.
/// @throws Error where there is no row of data.
MarkerTable ParsePointsCsv(std::string_view content, const std::string& file,
                           Warnings* warnings = nullptr);

}  // namespace mmm_converter
