// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/exchanged_sides.h"
#include "common/convert/tracking_setup.h"
#include "common/fit/height_estimate.h"
#include "common/model/kinematic_model.h"
#include "common/model/posture.h"
#include "common/motion/marker_sequence.h"
#include "common/motion/pose_trajectory.h"
#include "common/support/units.h"

namespace mmm_converter {

/// How far a label is worn from where its name says.
struct LabelPlace {
  std::string label;
  double noise_scale = 1;  ///< of its assignment
  /// Over the noise scale [m]: ToldDistances or WornDistances, whichever is larger; NaN: not known.
  double distance = kNaN;
};

/// By assignment. trajectory: of the markers' frames.
std::vector<LabelPlace> MeasurePlaces(const TrackingSetup& setup, const MarkerSequence& markers,
                                      const PoseTrajectory& trajectory);

/// FindExchangedSides on the reference scaled to the person without its subject, whose markers may
/// have taken an exchange up.
std::optional<ExchangedSides> FindExchangedSides(TrackingSetup setup,
                                                 std::shared_ptr<const KinematicModel> reference,
                                                 PersonScaling person,
                                                 const MarkerSequence& markers);

/// The height that the markers tell; nothing: no frame shows enough of them. track: as of
/// EstimateHeight.
std::optional<HeightEstimate> TellHeight(const TrackingSetup& setup,
                                         const KinematicModel& reference,
                                         const MarkerSequence& markers,
                                         const std::vector<Posture>* track);

/// What a verdict asks of labels that raise doubts, which takes fits.
struct LabelFigures {
  std::vector<LabelPlace> places;       ///< empty: not asked for
  std::optional<ExchangedSides> sides;  ///< nothing: none, or not asked for
};

/// How points were named.
struct NamingFigures {
  int num_names = 0;
  std::vector<std::string> missing;  ///< names that no point has in any frame
  int spare_points = 0;              ///< that have no name in most frames of the recording
  double unsure = kNaN;  ///< 1 - probability of the names, mean over frames; NaN: there are none
};

/// How named points fit the person's markers in the best postures of some frames [m].
struct LabelFit {
  double mean_distance = kNaN, p95_distance = kNaN;  ///< NaN: too few are named
  double farthest = 0;                               ///< of a name, on average
  std::vector<std::string> far_names;                ///< beyond kMarkerMean on average
  double told_height = 0;                            ///< that the points tell; 0: not known
};

}  // namespace mmm_converter
