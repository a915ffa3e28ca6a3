// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"

namespace mmm_converter {

/// Names of the joints that are tracked, in the order of a result's angles.
std::vector<std::string> TrackedJoints(const TrackingSetup& setup);

/// Of the markers that are tracked, by assignment. labels: of the frames.
std::vector<std::string> UsedLabels(const TrackingSetup& setup,
                                    const std::vector<std::string>& labels);

/// Of an estimate the tracked joints alone, as a PoseTrajectory has them. deviations: 6 + tracked
/// joints; they stay where the converter knows none. Allocates nothing once the posture has its
/// size.
void TakeTracked(const TrackingSetup& setup, const FrameEstimate& estimate, Posture* posture,
                 Eigen::Ref<Eigen::VectorXd> deviations);

}  // namespace mmm_converter
