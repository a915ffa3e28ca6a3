// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/tracking_setup.h"
#include "common/judge/evidence.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// What no body does for long: joints of legs that stand at a limit which is not their rest (a knee
/// is straight at one), but for those that hardly a marker shows; an ankle above its hip where the
/// pelvis is upright; a sole that slopes where the foot's markers lie as they do on flat ground.
/// recording: what was tracked, the frames of the trajectory.
void JudgeBodyLimits(const TrackingSetup& setup, const MarkerSequence& recording,
                     const PoseTrajectory& trajectory, bool is_calibrated, VerdictReasons* reasons);

}  // namespace mmm_converter
