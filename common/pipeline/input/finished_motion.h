// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/io/mmm/mmm_motion.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// The motion of a file that has postures: the named one, or else the only one, or the one named as
/// `preferred`.
/// @throws Error listing the motions where that does not decide it, and where angles are missing.
MmmMotion ReadPostures(const std::string& file, const std::string& preferred);

/// Frames of `trajectory` at the times of `markers`.
/// @throws Error naming `file` where rates differ or frames are not covered.
PoseTrajectory AlignFrames(const PoseTrajectory& trajectory, const MarkerSequence& markers,
                           const std::string& file);

}  // namespace mmm_converter
