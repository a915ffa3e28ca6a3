// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/convert/marker_mapping.h"
#include "common/io/model_file.h"
#include "common/model/coordinate_task.h"

namespace mmm_converter {

/// A `<Marker name="" segment="" x_mm="" y_mm="" z_mm=""/>`: where a marker is worn.
struct MarkerPlace {
  std::string marker;
  std::string segment;                             ///< or joint or, of a URDF, link
  Eigen::Vector3d p_SM = Eigen::Vector3d::Zero();  ///< in axes of the segment, not scaled [m]
  int line = 0;
};

/// A `<MarkerSet name="">` file: which labels of a laboratory's marker set stand for which model
/// markers. Several `<Mapping source="" target="" noiseScale="" warning=""/>` with the same target
/// are substitutes, the best first. Markers that the set places need no mapping: their label is
/// their name.
///
/// A file that PartMarkerSetParsers knows is one too.
struct MarkerSet {
  std::string file;
  std::string name;
  std::string description;
  std::vector<MarkerPair> pairs;
  std::vector<MarkerPlace> places;  ///< for models without these markers, or with them elsewhere
  std::vector<CoordinateTask> coordinate_tasks = {};
};

/// Nothing: it is no file of that kind. @throws Error as ReadMarkerSet.
using MarkerSetParser = std::optional<MarkerSet>(std::string_view content, const std::string& path);
/// Of marker sets in formats of parts (common/part_formats.cc).
const std::vector<MarkerSetParser*>& PartMarkerSetParsers();

/// @throws Error with file and line for anything that is not well-formed or not allowed.
MarkerSet ReadMarkerSet(const std::string& path);

/// All *.xml files of a folder, by name. @throws Error as ReadMarkerSet, or where there is none.
std::vector<MarkerSet> ReadMarkerSets(const std::string& folder);

/// The model with the markers that the set places.
/// @throws Error with file and line for each segment that the model does not have.
KinematicModel PlaceMarkers(const MarkerSet& set, const LoadedModel& model);

/// The set in which each marker of the model is labelled by its name.
MarkerSet OwnMarkerSet(const KinematicModel& model);

/// The pairs whose target the model has: not every model has every marker of a set.
std::vector<MarkerPair> PairsInModel(const MarkerSet& set, const KinematicModel& model);

/// How many model markers the set finds a label for.
int CountMappedMarkers(const MarkerSet& set, const std::vector<std::string>& labels);

/// As ChooseMarkerSet; null where no set maps three.
const MarkerSet* FindMarkerSet(const std::vector<MarkerSet>& sets, const MarkerLabels& labels);

/// The set that maps most markers; of equal ones the one that trusts them more, then the first.
/// @throws Error where no set maps three; the message lists the sets and labels of the recording.
const MarkerSet& ChooseMarkerSet(const std::vector<MarkerSet>& sets, const MarkerLabels& labels);

}  // namespace mmm_converter
