// SPDX-License-Identifier: MIT
#pragma once

#include "common/judge/verdict.h"
#include "common/retarget/retarget_figures.h"

namespace mmm_converter {

/// Whether a robot's motion is the person's, and what the robot could not do and where.
Verdict JudgeRetargeting(const RetargetFigures& figures);

}  // namespace mmm_converter
