// SPDX-License-Identifier: MIT
#pragma once

#include "common/motion/anatomical_angles.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

/// A row for each frame and angle, as statistics programs like them: time_s, joint, side (left,
/// right or empty), angle, degrees, sd_degrees (its standard deviation; empty: not known). The
/// angles must outlive the text.
TextPieces FormatAngleCsv(const AnatomicalAngles& angles);

}  // namespace mmm_converter
