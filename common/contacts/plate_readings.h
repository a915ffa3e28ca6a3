// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/forces/plate_forces.h"
#include "common/motion/foot_motion.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Where a plate bears a person, its centre of pressure is under that person's foot, and the force
/// points to the body. Where that is not so, what else a file can mean is tried: corners in another
/// order, moments in another unit or sign, ORIGIN reversed, a polynomial stored across, channels of
/// other plates; of tables points in another unit, about another axis or of another force, and the
/// other foot. What all stances agree on is taken and told. Where nothing fits, a plate tells no
/// contact any more; returned is what speaks against each of these. known: frames that show both
/// legs; empty: all.
std::vector<std::string> FitPlatesToFeet(const FootMotion& motion, const KnownLegs& known,
                                         RecordedForces* forces, Warnings* warnings);

}  // namespace mmm_converter
