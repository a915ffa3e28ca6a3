// SPDX-License-Identifier: MIT
#pragma once

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// The same model, of which this joint moves as far as `upper` [rad, m].
KinematicModel WithUpperLimit(const KinematicModel& model, int joint, double upper);

}  // namespace mmm_converter
