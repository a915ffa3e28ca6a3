// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/marker_mapping.h"
#include "common/fit/height_estimate.h"
#include "common/fit/posture_fit.h"
#include "common/model/kinematic_model.h"
#include "common/model/model_scaling.h"
#include "common/model/subject.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// A joint that is drawn to a value beside what its markers say, as OpenSim's coordinate tasks are:
/// the goal is sum w |p - y|^2 / sum w + weight (q - value)^2, w = 1 / noise_scale^2 of each marker
/// seen.
struct JointTask {
  int joint = 0;      ///< index of the model
  double value = 0;   ///< [rad], sliding [m]
  double weight = 0;  ///< [m^2/rad^2], sliding [1]
};

/// What is tracked by which markers: all that a converter knows before the first frame.
struct TrackingSetup {
  std::shared_ptr<const KinematicModel> model;  ///< scaled to the person; of an object: as it is
  std::vector<int> joints;                      ///< tracked, indices of the model, in output order
  MarkerMapping mapping;
  std::string marker_set = {};  ///< its name; empty: the configuration has its own list
  std::vector<JointTask> joint_tasks = {};

  const std::vector<MarkerAssignment>& assignments() const { return mapping.assignments; }
};

/// What a reference model is scaled by.
struct PersonScaling {
  std::optional<WinterScaling> size;            ///< nothing: the model is as large as it is
  std::shared_ptr<const Subject> subject = {};  ///< what is known beyond the size; null: nothing
  /// What distances between landmarks show, where no subject is known (FindLandmarkBody); null:
  /// nothing.
  std::shared_ptr<const Subject> landmarks = {};
};

/// The joint tasks of a setup for fits of its tracked joints.
std::vector<JointPull> PullsOf(const TrackingSetup& setup);

/// Matches the labels with the markers of a model that is not scaled yet, by ResolveMarkerPairs,
/// ResolveMarkerMapping and ResolveJoints. The setup's model is the reference itself.
/// @throws Error as these.
TrackingSetup MatchMarkers(const MarkerLabels& labels,
                           std::shared_ptr<const KinematicModel> reference,
                           const ConverterConfig& config, Warnings* warnings = nullptr);

/// Of a model that is not scaled: warns of tracked joints that no assigned marker moves.
void WarnOfFreeJoints(const TrackingSetup& setup, const ConverterConfig& config,
                      Warnings* warnings);

/// EstimateHeight with the joints and markers of a setup; reference: the model before it was
/// scaled.
/// @throws Error where no frame shows three of the markers.
HeightEstimate EstimateHeight(const TrackingSetup& setup, const KinematicModel& reference,
                              const MarkerSequence& recording,
                              const std::vector<Posture>* track = nullptr);

/// The reference by ScaleWinter, and by FitToSubject or WithLandmarkBody. @throws Error as these.
KinematicModel ScaleModel(const KinematicModel& reference, const PersonScaling& person);

/// Scales the model of a setup that MatchMarkers made. @throws Error as ScaleModel.
void ScaleToPerson(const PersonScaling& person, TrackingSetup* setup);

/// All in one for a person who is known, or an object; no frame is needed, so that a live stream
/// has its setup before it starts. A configuration with `<Model name="None">` leaves the model as
/// it is; what it says of a subject is the caller's to read (ReadSubject).
/// @throws Error as MatchMarkers and ScaleModel.
TrackingSetup MakeTrackingSetup(const MarkerLabels& labels,
                                std::shared_ptr<const KinematicModel> reference,
                                const ConverterConfig& config, const PersonScaling& person,
                                Warnings* warnings = nullptr);

}  // namespace mmm_converter
