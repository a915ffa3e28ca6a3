// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/convert/marker_set.h"
#include "common/io/landmarks/label_readings.h"
#include "common/model/kinematic_model.h"

namespace mmm_converter {

/// What is known of a label by its name.
struct NamedLabel {
  std::string label;
  std::string landmark;          ///< "left heel"; empty: nothing is known of it
  std::string part;              ///< "left foot"
  std::string marker;            ///< of the set; empty: it is left out
  bool is_cluster = false;       ///< its name tells the segment only
  bool lacks_side = false;       ///< as those of one arm, which need none to be told apart
  bool is_contradicted = false;  ///< by the body: not where, or on the side, that its name says
  std::string note = {};         ///< why it is left out, or what was changed
  std::vector<LabelReading> readings = {};  ///< what it can mean, the one that was taken first
};

/// A marker set that was composed of names, and what it says of each label.
struct NamedMarkers {
  MarkerSet set;
  std::vector<NamedLabel> labels;

  int num_used() const;
  /// Labels of one limb whose names tell no side.
  int num_without_side() const;
  /// Whether they are several, of which the body tells the side; one or two are of something else.
  bool are_of_one_side() const { return num_without_side() >= 3; }
};

/// What the body says of the labels that it contradicts, those with the same to say together:
/// "LTHI (317 mm from the left thigh)".
std::vector<std::string> DescribeContradictions(const NamedMarkers& named);

/// "left heel"
std::string DescribeReading(const LabelReading& reading, const LandmarkTable& table);

/// Where a landmark is on a model of 1 m, of the side of the reading (of the left, where the side
/// is not known); nothing where the model has neither its marker nor its segment.
std::optional<ModelMarker> PlaceOf(const LabelReading& reading, const LandmarkTable& table,
                                   const KinematicModel& model);

/// The noise scale of a landmark: its deviation over that of the model's markers, within what skin
/// does.
double NoiseScaleOf(const Landmark& landmark);

/// Labels that mean landmarks (ReadLabels), each as the model's marker there or, where there is
/// none or another label has it, as a marker of its own that the set places.
NamedMarkers ComposeNamedMarkers(const MarkerLabels& labels, const KinematicModel& model,
                                 const LandmarkTable& table);

/// As ComposeNamedMarkers, of readings that have been chosen; labels without are left out.
NamedMarkers ComposeNamedMarkers(const std::vector<std::string>& labels,
                                 const std::vector<ReadLabel>& read, const KinematicModel& model,
                                 const LandmarkTable& table);

/// Labels and the markers of a model that are named after the same landmark, or alike. Nothing is
/// placed: a label whose landmark no marker of the model is named after is left out.
NamedMarkers PairByLandmarks(const MarkerLabels& labels, const KinematicModel& model,
                             const LandmarkTable& table);

/// Whether labels are those of a set that says where each of them is worn, and trusts none less: it
/// knows all whose names mean landmarks, and a laboratory's has half of its markers there.
bool IsOfSet(const NamedMarkers& named, const MarkerSet& set);

}  // namespace mmm_converter
