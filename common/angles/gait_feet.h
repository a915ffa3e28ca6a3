// SPDX-License-Identifier: MIT
#pragma once

#include "common/angles/gait.h"
#include "common/contacts/contacts.h"
#include "common/motion/foot_motion.h"

namespace mmm_converter {

/// From heel to toe against the way of the stride, toes inwards [rad]: joint "foot", motion
/// "progression". NaN: the stride has no way.
GaitCycle FootProgression(const FootMotion& feet, const Stride& stride);

/// The share of the stride in which both feet stand [0, 1]; NaN: when the foot left the ground is
/// not known.
double DoubleSupport(const Stride& stride, const Contacts& contacts);

/// Cycles of one stride each, all of the same angle and side, as one; at least one.
GaitCycle MeanOf(const std::vector<GaitCycle>& single);

}  // namespace mmm_converter
