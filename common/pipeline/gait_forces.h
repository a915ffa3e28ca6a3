// SPDX-License-Identifier: MIT
#pragma once

#include "common/pipeline/ground_study.h"

namespace mmm_converter {

/// Fills forces and work of the gait's strides (GaitOf), where there are plates and the model has a
/// mass.
void AddForces(const ConversionReport& report, const GroundStudy& ground, Gait* gait);

}  // namespace mmm_converter
