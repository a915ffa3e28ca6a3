// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/evaluate/comparison.h"

namespace mmm_converter {

/// What the page draws of a comparison, as JSON: models, measured markers, postures, distances.
/// Arrays are PackedArrays, in SI units, with frames running fastest unless said otherwise.
std::string FormatTracks(const Comparison& comparison);

}  // namespace mmm_converter
