// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "common/convert/named_markers.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct NameOptions {
  std::vector<int> joints;  ///< tracked ones
  /// A label whose segment only is known gets its place where the postures have it; else it keeps
  /// the usual one of its kind.
  bool places_clusters = true;
};

/// What the labels of a recording mean: by their names (ComposeNamedMarkers), as the body bears
/// them out in up to twelve frames spread over the recording. Postures are fitted to the labels
/// whose place is known, each trusted by its deviation, at the height that explains them best. A
/// label that is far from its place and near another one that its name can mean, or the same of the
/// other side, is taken for that; one that is far from all of them is left out; the notes say by
/// how much. Labels of one arm or leg without side are of the side that fits. reference: of 1 m.
/// Where no frame shows enough, names alone count.
NamedMarkers UnderstandLabels(const MarkerLabels& labels, const MarkerSequence& recording,
                              const KinematicModel& reference, const LandmarkTable& table,
                              const NameOptions& options);

}  // namespace mmm_converter
