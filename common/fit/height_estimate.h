// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/model/kinematic_model.h"
#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct HeightEstimate {
  double height = 0;         ///< [m]
  double mean_distance = 0;  ///< over markers and frames at that height [m]
  int frames = 0;            ///< frames that were fitted
};

/// Body height at which the Winter-scaled reference model (1 m, 1 kg) fits a recording best: least
/// squares over height and the postures of up to twelve frames spread over the recording, those
/// with most markers seen. labels[i] is the recording's label of model marker markers[i]; joints:
/// tracked joints. track: a posture of every frame, of these joints, to start from; null: postures
/// are searched, which takes several times as long.
/// @throws Error where no frame shows at least ten of the markers.
HeightEstimate EstimateHeight(const KinematicModel& reference, const std::vector<int>& joints,
                              const std::vector<MarkerIx>& markers,
                              const std::vector<LabelIx>& labels, const MarkerSequence& recording,
                              const std::vector<Posture>* track = nullptr);

}  // namespace mmm_converter
