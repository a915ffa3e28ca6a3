// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/io/tables/marker_rows.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// True if text can be a TRC file (OpenSim, Motion Analysis): it has a line that starts with
/// `PathFileType` or `Frame#`.
bool LooksLikeTrc(std::string_view content);

/// Separated by tabs, commas, semicolons or blanks, lines ended by any system's ends; header lines
/// may be missing or wrong in their counts. Markers without any label are called by number, `*1`.
/// `file` is only named in messages.
/// @throws Error where there are no columns, no rows, or as ReadMarkerRows.
MarkerTable ParseTrc(std::string_view content, const std::string& file,
                     Warnings* warnings = nullptr);

}  // namespace mmm_converter
