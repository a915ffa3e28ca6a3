// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/study/coverage.h"

namespace mmm_converter {

/// Where an arm or a leg is that markers show.
struct LimbPlace {
  std::string limb;
  bool is_leg = false;
  std::vector<std::string> labels;
  double beside_trunk =
      0;  ///< share of the frames in which the trunk is upright and the leg beside
  /// How far the labels are that a knee or elbow moves, where it is at its straight end for most of
  /// the time, as if it would bend backwards [m]; else 0.
  double bent_back = 0;
};

/// limbs: LimbsOf(setup). residuals: by assignment and frame [m]; NaN: not seen.
std::vector<LimbPlace> MeasureLimbPlaces(const TrackingSetup& setup, const std::vector<Limb>& limbs,
                                         const MarkerSequence& markers,
                                         const PoseTrajectory& trajectory,
                                         const Eigen::MatrixXd& residuals);

}  // namespace mmm_converter
