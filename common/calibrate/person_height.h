// SPDX-License-Identifier: MIT
#pragma once

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

struct PersonHeight {
  double height = 0;     ///< [m]
  double deviation = 0;  ///< its standard deviation [m]
  int frames = 0;        ///< that it was taken from
};

/// The height of the person who wears the markers. By Winter it is what all lengths of the body
/// have in common, each being off by some percent, as are the places of all markers: these, the
/// postures of some frames and the height are estimated together (FitBody) from the height that
/// fits best with none of that (EstimateHeight). Where no frame shows ten of the markers, it is
/// weighed against what heights persons have (with_ordinary_height: always). setup: as MatchMarkers
/// made it, not scaled.
/// @throws Error where no frame shows three of the markers.
PersonHeight EstimatePersonHeight(const TrackingSetup& setup, const MarkerSequence& recording,
                                  bool with_ordinary_height = false);

}  // namespace mmm_converter
