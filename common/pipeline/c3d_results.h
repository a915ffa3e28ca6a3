// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/io/c3d/c3d_relabelling.h"
#include "common/pipeline/ground_study.h"

namespace mmm_converter {

/// Angles, and where there are plates moments and powers, as points of the recording's C3D file:
/// LHipAngles (flexion, adduction, internal rotation), LHipMoment, LHipPower (third value), with
/// the subject's prefix where the file's labels have it. Turns of pelvis, spine and neck stand
/// there as each side sees them. What a hidden leg would tell is not known, and neither is what the
/// file can't hold, which is warned of.
/// @throws Error where the file's frames have another rate than the motion.
std::vector<C3dResult> C3dResultsOf(const ConversionReport& report, const GroundStudy& ground,
                                    Warnings* warnings);

}  // namespace mmm_converter
