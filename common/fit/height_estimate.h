// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Of adults, both sexes together [m]: what is taken where markers tell nothing.
inline constexpr double kOrdinaryHeight = 1.72, kHeightDeviation = 0.1;

struct HeightEstimate {
  double height = 0;         ///< [m]
  double mean_distance = 0;  ///< over markers and frames at that height [m]
  int frames = 0;            ///< frames that were fitted
  /// Standard deviation [m]; 0 where ten markers or more tell the height and it was not asked for.
  double deviation = 0;
};

struct HeightOptions {
  /// A posture of every frame, of the tracked joints, to start from; null: postures are searched,
  /// which takes several times as long.
  const std::vector<Posture>* track = nullptr;
  /// By marker; empty: all are trusted alike.
  Eigen::VectorXd noise_scale = {};
  /// Weighs what the markers tell against what heights persons have, whatever the markers are;
  /// else only where no frame shows ten of them.
  bool with_ordinary_height = false;
};

/// Body height at which the Winter-scaled reference model (1 m, 1 kg) fits a recording best: least
/// squares over height and the postures of up to twelve frames spread over the recording, those
/// with most markers seen. labels[i] is the recording's label of model marker markers[i]; joints:
/// tracked joints.
/// @throws Error where no frame shows three of the markers.
HeightEstimate EstimateHeight(const KinematicModel& reference, const std::vector<int>& joints,
                              const std::vector<MarkerIx>& markers,
                              const std::vector<LabelIx>& labels, const MarkerSequence& recording,
                              const HeightOptions& options = {});

}  // namespace mmm_converter
