// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/pipeline.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// The model of the recorded person: the reference scaled by height and mass, or as it is where the
/// configuration says so. Height, mass and hand length are taken from the request, the processor
/// file, or the recording, in this order; then the height is estimated from the markers and the
/// mass assumed. Says in the report what was taken and from where.
KinematicModel ScaleToPerson(const ConversionRequest& request, const KinematicModel& reference,
                             ConversionReport* report);

}  // namespace mmm_converter
