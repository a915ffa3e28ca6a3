// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/convert/tracking_setup.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// Markers of the pelvis that change their places against each other and stay there.
struct SlippedMarkers {
  std::vector<std::string> labels;
  double time = 0;      ///< about when [s]
  double distance = 0;  ///< by which one moved at least, if one alone did [m]
};

inline constexpr double kSlipWindow = 2;  ///< [s], which two strides take

/// What the shape of the four iliac spines changes most from one time to the next. Skin moves them
/// with the gait: shapes are means over kSlipWindow or more. Nothing: not all four are there, for
/// so long.
std::optional<SlippedMarkers> FindSlippedPelvis(const TrackingSetup& setup,
                                                const MarkerSequence& recording);

}  // namespace mmm_converter
