// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "MMMConverterS2KF/dynamics/checked_motion.h"
#include "MMMConverterS2KF/dynamics/plausibility.h"
#include "common/dynamics/motion_dynamics.h"

namespace mmm_converter {

/// What was checked, and what came out.
struct DynamicsReport {
  CheckedMotion motion;
  MotionDynamics dynamics;
  Plausibility plausibility;
};

/// Figures and checks, for people; the last line is one sentence.
std::string FormatDynamicsSummary(const DynamicsReport& report);

/// All figures as JSON; README.md says what is in it. What there is no number for is null.
std::string FormatDynamicsJson(const DynamicsReport& report);

/// The verdict in one sentence.
std::string DynamicsSentence(const DynamicsReport& report);

}  // namespace mmm_converter
