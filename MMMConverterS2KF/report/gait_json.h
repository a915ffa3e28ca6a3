// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/ground_study.h"

namespace mmm_converter {

/// What the page says of strides: figures of each foot, angles over the cycle and, where there are
/// plates, forces and moments. Null: there is no stride, or the model has no names for its angles.
Json GaitPageJson(const ConversionReport& report, const GroundStudy& ground);

}  // namespace mmm_converter
