// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Per frame the mean marker distance at the least-squares posture [m], the floor of every tracker:
/// Levenberg-Marquardt to convergence, warm-started along the recording forwards and backwards; the
/// better of both counts. labels[i] is the recording's label of model marker markers[i]. NaN:
/// fewer than three of the markers were measured.
Eigen::VectorXd OptimalDistances(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<int>& markers, const std::vector<int>& labels,
                                 const MarkerSequence& recording);

}  // namespace mmm_converter
