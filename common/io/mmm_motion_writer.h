// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/io/mmm_motion.h"

namespace mmm_converter {

// Parts of an MMM 2.0 motion, indented for their place in it. The public functions are in
// mmm_motion.h.

/// <Model> with its ModelProcessorConfig; neither indented at its start nor ended by a new line.
std::string FormatModelElement(const MmmMotionOutput& output);

/// The <Sensor> elements ModelPose, Kinematic and, if there are markers, MoCapMarker: whole lines.
std::string FormatSensorElements(const MmmMotionOutput& output);

}  // namespace mmm_converter
