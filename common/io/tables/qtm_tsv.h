// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/tables/marker_rows.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// True if text can be a TSV export of Qualisys Track Manager: it starts with "NO_OF_FRAMES".
bool LooksLikeQtmTsv(std::string_view content);

/// The trajectories of a TSV export of Qualisys Track Manager: a key and its values in each line
/// (NO_OF_FRAMES, FREQUENCY, MARKER_NAMES, ...), then rows of x, y, z [mm] for each marker. As the
/// export was set, a line names the columns and each row begins with frame and time.
/// @throws Error where there are no 3D data, and as ReadMarkerRows.
MarkerTable ParseQtmTsv(std::string_view content, const std::string& file,
                        Warnings* warnings = nullptr);

}  // namespace mmm_converter
