// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "tests/report/comparison_cases.h"

namespace mmm_converter::testing {

/// GroundJson of so many frames, with hostile notes: 700 N are a body weight. Plate 1 bears it in
/// the first half for the left foot, plate 2 twice that in the second half for the right one.
/// Strides over which all grows by the percent of the cycle, with a normal band of the knee and
/// scores of 6 and 8 degrees.
Json GroundCase(int frames);

/// PatientJson of somebody with a hostile name.
Json PatientCase();

}  // namespace mmm_converter::testing
