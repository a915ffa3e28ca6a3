// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/dynamics/motion_dynamics.h"
#include "common/kinetics/joint_forces.h"
#include "common/pipeline/dynamics/checked_motion.h"
#include "common/pipeline/dynamics/plausibility.h"
#include "common/pipeline/option.h"

namespace mmm_converter {

/// What was checked, and what came out.
struct DynamicsReport {
  CheckedMotion motion;
  MotionDynamics dynamics;
  Plausibility plausibility;
  /// With the forces of motion.forces_file instead of what is assumed of the ground.
  std::optional<JointForces> with_forces = {};
};

/// The table of what is asked of a check.
std::vector<Option> Options(DynamicsOptions* options);

/// Judges the dynamics of a motion. progress: as ComputeMotionDynamics.
/// @throws Error; also where this program was built without Simbody.
DynamicsReport CheckDynamics(CheckedMotion motion, const DynamicsOptions& options,
                             const std::function<void(int, int)>& progress = {});

}  // namespace mmm_converter
