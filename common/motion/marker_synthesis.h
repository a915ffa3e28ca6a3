// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// How the markers of a synthetic recording differ from the model's. All standard deviations are
/// per axis [m]; the defaults are what real recordings show.
struct MarkerErrors {
  double offset = 0.028;               ///< constant per marker, in the segment's frame
  double wobble = 0.004;               ///< soft tissue: Ornstein-Uhlenbeck in the segment's frame
  double wobble_time_constant = 0.25;  ///< [s] > 0
  double noise = 0.0001;               ///< white, in W
};

/// Where the model's markers are seen during `motion`. Labels are the markers' names without
/// MMM's prefix "MARKER_". Joints that the trajectory does not name are 0, clamped into their
/// limits. Offsets and wobble of a marker do not depend on which motion is played.
/// @throws Error where the trajectory names a joint that the model does not have.
MarkerSequence SynthesizeMarkers(const KinematicModel& model, const PoseTrajectory& motion,
                                 const MarkerErrors& errors, std::uint64_t seed);

/// The model posture of frame k of `motion`: joints by name, those not named as in ZeroPosture.
/// @throws Error where the trajectory names a joint that the model does not have.
Posture ModelPosture(const KinematicModel& model, const PoseTrajectory& motion, int k);

}  // namespace mmm_converter
