// SPDX-License-Identifier: MIT
#include "common/live/marker_states.h"

#include "common/support/units.h"

namespace mmm_converter {

MarkerStates StatesOfMarkers(const LiveBody& body, const PoseFrame& frame) {
  const auto labels = static_cast<std::size_t>(frame.points.cols());
  MarkerStates markers{std::vector<MarkerState>(labels, MarkerState::kHidden),
                       std::vector<double>(labels, kNaN)};
  for (std::size_t i = 0; i < labels; ++i) {
    if (IsSeen(frame.points.col(static_cast<Eigen::Index>(i)))) {
      markers.states[i] = MarkerState::kUnused;
    }
  }
  if (!frame.is_tracking) return markers;
  const auto& assignments = body.setup.assignments();
  const Eigen::VectorXi& verdicts = frame.estimate.verdicts;
  for (std::size_t i = 0; i < assignments.size(); ++i) {
    const auto label = static_cast<std::size_t>(assignments[i].label);
    if (markers.states[label] == MarkerState::kHidden) continue;
    const auto row = static_cast<Eigen::Index>(i);
    markers.distances[label] = frame.estimate.residuals[row];
    const bool is_wrong = verdicts.size() > 0 && verdicts[row] != kAsLabelled;
    markers.states[label] = is_wrong ? MarkerState::kWrong : MarkerState::kUsed;
  }
  return markers;
}

}  // namespace mmm_converter
