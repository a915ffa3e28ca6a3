// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/input/input.h"
#include "MMMConverterS2KF/report/dynamics_summary.h"
#include "common/dynamics/motion_dynamics.h"

namespace mmm_converter {

/// Reads a motion and judges its dynamics.
/// @throws Error; also where this program was built without Simbody.
DynamicsReport CheckDynamics(const InputRequest& request, const DynamicsOptions& options);

}  // namespace mmm_converter
