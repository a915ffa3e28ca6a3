// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/model/coordinate_task.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Tasks of coordinates as those of joints. Those of coordinates that are no joints are left out:
/// locked ones keep their value anyway; of a floating root, and of those that follow others, a
/// warning tells.
/// @throws Error where the model has no such coordinate.
std::vector<JointTask> ResolveCoordinateTasks(const std::vector<CoordinateTask>& tasks,
                                              const KinematicModel& model, Warnings* warnings);

}  // namespace mmm_converter
