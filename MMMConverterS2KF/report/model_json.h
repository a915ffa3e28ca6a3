// SPDX-License-Identifier: MIT
#pragma once

#include "MMMConverterS2KF/report/json.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// Segments with their places in their parents, markers and joints: what the pages draw a body
/// from. SI units, quaternions x y z w.
Json ToJson(const KinematicModel& model);

}  // namespace mmm_converter
