// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// Person data of MMM's `ModelProcessorConfig type="Winter"`.
struct WinterScaling {
  double height = 0;                  ///< [m]
  double mass = 0;                    ///< [kg]
  std::optional<double> hand_length;  ///< [m]
};

/// Scales the reference model of a 1 m, 1 kg person (Winter): every translation, marker offset and
/// CoM times height, masses times mass, inertia times mass * height^2.
/// @throws Error where height is outside [0.5, 2.5] m, mass outside [1, 400] kg, or hand_length
/// outside
///         [0.05, 0.4] m.
KinematicModel ScaleWinter(const KinematicModel& reference, const WinterScaling& person);

}  // namespace mmm_converter
