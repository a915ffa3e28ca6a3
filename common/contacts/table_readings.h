// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/forces/plate_forces.h"
#include "common/motion/foot_motion.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// FitPlatesToFeet of forces that a table holds.
std::vector<std::string> FitTableToFeet(const FootMotion& motion, const KnownLegs& known,
                                        RecordedForces* forces, Warnings* warnings);

}  // namespace mmm_converter
