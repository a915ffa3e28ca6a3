// SPDX-License-Identifier: MIT
#pragma once

#include "common/judge/verdict.h"
#include "common/retarget/retarget_figures.h"

namespace mmm_converter {

/// Whether a robot's motion is the person's, and what the robot could not do and where.
/// of_conversion: of the recording, whose doubts are the motion's, too; null: the motion was
/// finished.
Verdict JudgeRetargeting(const RetargetFigures& figures, const Verdict* of_conversion);

}  // namespace mmm_converter
