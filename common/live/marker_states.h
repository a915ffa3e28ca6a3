// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "common/live/pose_frame.h"

namespace mmm_converter {

enum class MarkerState : std::uint8_t {
  kHidden = 0,  ///< not seen in this frame
  kUsed = 1,    ///< seen, and as it is labelled
  kWrong = 2,   ///< seen, but not where its label says: left out, or taken for another
  kUnused = 3,  ///< seen, but the body has no such marker, or there is no posture
};

/// By label.
struct MarkerStates {
  std::vector<MarkerState> states;
  std::vector<double> distances;  ///< from the model's marker [m]; NaN: none
};

MarkerStates StatesOfMarkers(const LiveBody& body, const PoseFrame& frame);

}  // namespace mmm_converter
