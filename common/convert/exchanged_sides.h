// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Markers of the left that bear the labels of the right, and the other way round, in a whole
/// recording. A recording with mirrored coordinates looks the same.
struct ExchangedSides {
  std::string part;               ///< "all markers", "the arms" or "the legs"
  double distance = 0;            ///< mean marker distance of some frames' best postures [m]
  double exchanged_distance = 0;  ///< the same with the labels of the part exchanged [m]
  std::vector<std::pair<LabelIx, LabelIx>> labels;  ///< of the part, which belong together
};

/// The part whose labels, exchanged, have postures clearly nearer to the markers in some frames of
/// the recording; nothing where there is none. setup: the model has been scaled to the person.
std::optional<ExchangedSides> FindExchangedSides(const TrackingSetup& setup,
                                                 const MarkerSequence& recording);

/// The recording with these labels exchanged.
MarkerSequence WithLabelsExchanged(const ExchangedSides& sides, const MarkerSequence& recording);

}  // namespace mmm_converter
