// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/motion/marker_sequence.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A TRC file (OpenSim, Motion Analysis) as it stands.
struct TrcFile {
  MarkerSequence markers;  ///< file units and axes; missing: NaN
  std::string unit;        ///< empty: the file does not say
  long first_frame = 1;
  long declared_frames = 0;  ///< NumFrames; 0: the file does not say
};

/// True if text can be a TRC file: it has a line that starts with `PathFileType` or `Frame#`.
bool LooksLikeTrc(std::string_view content);

/// Tab, comma or semicolon separated, by column position; header lines may be missing or wrong in
/// their counts. `file` is only named in messages.
/// @throws Error where there are no labels, no rows, or no rate.
TrcFile ParseTrc(std::string_view content, const std::string& file, Warnings* warnings = nullptr);

}  // namespace mmm_converter
