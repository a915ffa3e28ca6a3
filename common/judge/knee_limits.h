// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/tracking_setup.h"
#include "common/judge/evidence.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// Knees of the reference model end where the leg is straight. Says so where markers show one that
/// bends backwards: frames at that limit are fitted anew with a limit that lies further back.
void JudgeKnees(const TrackingSetup& setup, const MarkerSequence& recording,
                const PoseTrajectory& trajectory, VerdictReasons* reasons);

}  // namespace mmm_converter
