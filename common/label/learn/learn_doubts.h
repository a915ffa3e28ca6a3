// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/label/learn/body_sites.h"
#include "common/label/learn/learn_markers.h"
#include "common/label/learn/learned_places.h"

namespace mmm_converter {

/// What markers were learnt from.
struct LearnEvidence {
  const BodySites& sites;
  const LearnedPlaces& learned;
  const Eigen::MatrixXd& deviations;      ///< DistanceDeviations
  const std::vector<std::string>& names;  ///< labels
  const std::vector<NamedPlace>& named;   ///< by label
};

/// Leaves out, with the reason, those of which what is known is not enough, and warns where names
/// contradict the body. markers: as learnt, with their probabilities.
void LeaveOutDoubtful(const LearnEvidence& evidence, LearnedMarkers* markers);

}  // namespace mmm_converter
