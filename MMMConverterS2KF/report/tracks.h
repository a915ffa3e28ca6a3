// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/comparison/comparison.h"

namespace mmm_converter {

/// What the page draws of a comparison: models, measured markers, postures, distances.
/// Arrays are PackedArrays, in SI units, of the DrawnFrames; frames run fastest unless said
/// otherwise.
Json TracksJson(const Comparison& comparison);

}  // namespace mmm_converter
