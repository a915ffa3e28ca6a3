// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// How far a knee of the reference model, which ends where the leg is straight, would bend
/// backwards in these frames, in which it is at that limit [rad]: the median of some of them, which
/// are fitted anew with a limit that lies further back. joint: tracked, of the model; frames: not
/// empty.
double KneeBeyondStraight(const TrackingSetup& setup, const MarkerSequence& recording,
                          const PoseTrajectory& trajectory, int joint,
                          const std::vector<int>& frames);

}  // namespace mmm_converter
