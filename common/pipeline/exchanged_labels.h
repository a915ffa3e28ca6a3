// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The recording with left and right labels exchanged, where they are the wrong way round all along
/// (FindExchangedSides), which a warning says: a tracker that begins with the wrong side could mend
/// one part and not another. setup: its labels are numbers of names; stored: the recording's column
/// that is called like each name, -1: none.
std::optional<MarkerSequence> ExchangeSides(TrackingSetup setup, const std::vector<LabelIx>& stored,
                                            const MarkerSequence& recording, Warnings* warnings);

/// The recording with labels whose names the body contradicts under the names of where they are, as
/// far as these are contradicted, too: sides, pairs. A warning tells. Nothing where there are none.
/// named: the recording's labels by their names alone; understood: as the body bears them out.
std::optional<MarkerSequence> ExchangeNames(const NamedMarkers& named,
                                            const NamedMarkers& understood,
                                            const MarkerSequence& recording, Warnings* warnings);

}  // namespace mmm_converter
