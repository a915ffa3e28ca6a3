// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"
#include "common/study/body_limits.h"
#include "common/study/coverage.h"
#include "common/study/limb_places.h"
#include "common/study/slipped_markers.h"
#include "common/support/units.h"

namespace mmm_converter {

/// How the trunk is held: shares of the frames; NaN of a model whose root is fixed.
struct TrunkFigures {
  double lying = kNaN;        ///< more than 60 degrees from upright
  double upside_down = kNaN;  ///< more than 60 degrees beyond level
};

/// What a track shows of the body, or of the object, whose markers were recorded.
struct BodyFigures {
  std::vector<Gap> gaps;  ///< LongGaps
  // Of an object:
  double radius = kNaN;  ///< of its assigned markers [m]
  // Of a person:
  Coverage coverage;
  std::vector<LimbPlace> limb_places;
  /// How far half of the markers go further from the frame before to this one than both before and
  /// after it [m]: a body that is elsewhere within a frame, and as slow before as after. NaN: too
  /// few markers are seen.
  std::vector<double> jumps;
  double noise = kNaN;  ///< MeasureMarkerNoise [m]
  TrunkFigures trunk;
  BodyLimits limits;
  std::optional<SlippedMarkers> slipped;
};

BodyFigures MeasureBody(const TrackingSetup& setup, const MarkerSequence& markers,
                        const ConversionResult& result);
BodyFigures MeasureObject(const TrackingSetup& setup, const MarkerSequence& markers);

}  // namespace mmm_converter
