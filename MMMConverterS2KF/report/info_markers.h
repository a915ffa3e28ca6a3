// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// A table: per label the frames in which it is seen and its mean position [m].
std::string FormatMarkers(const MarkerSequence& markers);

/// The same as JSON text (an array).
std::string FormatMarkersJson(const MarkerSequence& markers);

}  // namespace mmm_converter
