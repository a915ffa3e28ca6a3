// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// Person data of MMM's `ModelProcessorConfig type="Winter"`.
struct WinterScaling {
  double height = 0;                  ///< [m]
  double mass = 0;                    ///< [kg]
  std::optional<double> hand_length;  ///< wrist to finger tip [m]
};

/// Hand length of a 1 m person in Winter's table [m].
inline constexpr double kWinterHandLength = 0.108;

/// Scales the reference model of a 1 m, 1 kg person (Winter): every translation, marker offset and
/// CoM times height, masses times mass, inertia times mass * height^2.
/// With hand_length, the lengths of the hands, which are the nodes below the wrist joints LWy_joint
/// and RWy_joint with their markers, are scaled by hand_length / 0.108 instead of height, and their
/// inertia to match. MMM does not publish its own rule for HandLength; this is our reading.
/// @throws Error where height is outside [0.5, 2.5] m, mass outside [1, 400] kg, or hand_length
///         outside [0.05, 0.4] m or given for a model without these wrist joints.
KinematicModel ScaleWinter(const KinematicModel& reference, const WinterScaling& person);

}  // namespace mmm_converter
