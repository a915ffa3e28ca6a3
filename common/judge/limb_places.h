// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/convert/motion_converter.h"
#include "common/convert/tracking_setup.h"
#include "common/judge/coverage.h"
#include "common/judge/evidence.h"

namespace mmm_converter {

/// Names limbs that are where a person's can't be for most of the time: a leg beside the trunk, a
/// knee or elbow at its straight end whose markers would have it bend backwards. limbs:
/// LimbsOf(setup).
void JudgeLimbPlaces(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                     const MarkerSequence& markers, const ConversionResult& result,
                     VerdictReasons* reasons);

}  // namespace mmm_converter
