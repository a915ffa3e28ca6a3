// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"

namespace mmm_converter {

/// Per frame the mean marker distance at the least-squares posture [m], the floor of every tracker:
/// Levenberg-Marquardt to convergence, warm-started along the recording forwards and backwards; the
/// better of both counts. labels[i] is the recording's label of model marker markers[i]. NaN:
/// fewer than three of the markers were measured.
Eigen::VectorXd OptimalDistances(const KinematicModel& model, const std::vector<int>& joints,
                                 const std::vector<MarkerIx>& markers,
                                 const std::vector<LabelIx>& labels,
                                 const MarkerSequence& recording);

/// How the optimum of a long recording is found.
struct OptimumSampling {
  int every = 1;  ///< frames from one that is fitted to the next
  /// Motions of the model that were tracked: fits start there, or from the neighbour, where the
  /// cost is lower.
  std::vector<const PoseTrajectory*> tracked;
  /// Called frame by frame, forwards, with what the optimum is at least and at most: whether that
  /// is too little to know. Of a frame that is fitted, both are its optimum.
  std::function<bool(int frame, double least, double most)> is_doubtful;
};

/// OptimalDistances of every n-th frame and of those in doubt; linear between. In doubt, an optimum
/// is taken to be within a tenth, and the difference of the fitted frames around it, of these.
Eigen::VectorXd SampledOptimalDistances(const KinematicModel& model, const std::vector<int>& joints,
                                        const std::vector<MarkerIx>& markers,
                                        const std::vector<LabelIx>& labels,
                                        const MarkerSequence& recording,
                                        const OptimumSampling& sampling);

}  // namespace mmm_converter
