// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

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

/// Judges the dynamics of a motion. progress: as ComputeMotionDynamics.
/// @throws Error; also where this program was built without Simbody.
DynamicsReport CheckDynamics(CheckedMotion motion, const DynamicsOptions& options,
                             const std::function<void(int, int)>& progress = {});

}  // namespace mmm_converter
