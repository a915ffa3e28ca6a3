// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/io/mmm/mmm_motion.h"
#include "common/support/text_pieces.h"

namespace mmm_converter {

// Parts of an MMM 2.0 motion, indented for their place in it. The public functions are in
// mmm_motion.h.

/// `<Model>` with its ModelProcessorConfig; neither indented at its start nor ended by a new line.
std::string FormatModelElement(const MmmMotionOutput& output);

/// @throws Error where a posture is not finite.
void CheckWritable(const MmmMotionOutput& output);

/// The `<Sensor>` elements ModelPose, Kinematic and MoCapMarker, as far as the output has these;
/// the first is not indented, the last is not ended by a new line.
void AppendSensorElements(const MmmMotionOutput& output, PieceWriter* pieces);

}  // namespace mmm_converter
