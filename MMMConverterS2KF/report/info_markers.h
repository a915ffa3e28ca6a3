// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/report/json.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// A table: per label the frames in which it is seen and its mean position [m].
std::string FormatMarkers(const MarkerSequence& markers);

/// The same as an array.
Json MarkersJson(const MarkerSequence& markers);

}  // namespace mmm_converter
