// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// As ToldDistances, of some frames together: what one frame takes up as posture another one does
/// not, as a marker stays where it is worn. Unknown are postures, lengths of segments and where
/// each label is worn. By assignment, sigma sqrt(o' (sigma^2 I - P)^-1 o) over the noise scale [m],
/// o being the likeliest offset of the label from its place and P its covariance. A label that
/// moves on its segment, as one that is worn on another, shows less here. NaN: not seen in these
/// frames, or one of more than 150 labels.
Eigen::VectorXd WornDistances(const TrackingSetup& setup, const MarkerSequence& markers,
                              const PoseTrajectory& trajectory);

}  // namespace mmm_converter
