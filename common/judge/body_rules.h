// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/judge/evidence.h"
#include "common/study/body_limits.h"
#include "common/study/limb_places.h"
#include "common/study/slipped_markers.h"

namespace mmm_converter {

/// Names what no body does for long: joints of legs that stand at their limits, an ankle above its
/// hip where the pelvis is upright, a sole that slopes where the foot lies flat.
void JudgeBodyLimits(const BodyLimits& limits, bool is_calibrated, VerdictReasons* reasons);

/// Tells of a pelvis whose markers changed their places against each other.
void JudgeSlips(const std::optional<SlippedMarkers>& slipped, VerdictReasons* reasons);

/// Names limbs that are where a person's can't be for most of the time.
void JudgeLimbPlaces(const std::vector<LimbPlace>& places, VerdictReasons* reasons);

}  // namespace mmm_converter
