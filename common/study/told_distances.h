// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// How far labels are from their places, beyond what the posture takes up of it: a foot turns to a
/// heel that is worn too low, and the heel's residual shows less of that than the sternum's would.
/// By assignment, the distance of a label that no posture follows and that is as unlikely, over its
/// noise scale [m]: sigma sqrt(r' (I - H)^-1 r), as studentised residuals in regression, r being
/// the residual over sigma and H the label's part of the hat matrix of the fit of a frame; the
/// median over some frames. NaN: not seen in these.
Eigen::VectorXd ToldDistances(const TrackingSetup& setup, const MarkerSequence& markers,
                              const PoseTrajectory& trajectory);

}  // namespace mmm_converter
