// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

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

// What ScaleWinter takes: beyond, a unit is wrong.
inline constexpr double kLeastHeight = 0.5, kLargestHeight = 2.5;           ///< [m]
inline constexpr double kLeastMass = 1, kLargestMass = 400;                 ///< [kg]
inline constexpr double kLeastHandLength = 0.05, kLargestHandLength = 0.4;  ///< [m]

/// What ScaleWinter multiplies the lengths of each segment by, in the order of the model.
/// @throws Error as ScaleWinter.
std::vector<double> WinterLengths(const KinematicModel& reference, const WinterScaling& person);

/// Scales the reference model of a 1 m, 1 kg person (Winter): every translation, marker offset and
/// CoM times height, masses times mass, inertia times mass * height^2.
/// With hand_length, the lengths of the hands, which are the nodes below the wrist joints LWy_joint
/// and RWy_joint with their markers, are scaled by hand_length / 0.108 instead of height, and their
/// inertia to match. MMM does not publish its own rule for HandLength; this is our reading.
/// @throws Error where height, mass or hand_length is outside of the limits above, or hand_length
/// is
///         given for a model without these wrist joints.
KinematicModel ScaleWinter(const KinematicModel& reference, const WinterScaling& person);

}  // namespace mmm_converter
