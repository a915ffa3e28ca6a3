// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "tests/report/comparison_cases.h"

namespace mmm_converter::testing {

/// GroundJson of so many frames, with hostile notes: 700 N are a body weight. Plate 1 bears it in
/// the first half for the left foot, plate 2 twice that in the second half for the right one. Two
/// strides of the left foot whose knee bends by the percent of the cycle.
Json GroundCase(int frames);

}  // namespace mmm_converter::testing
