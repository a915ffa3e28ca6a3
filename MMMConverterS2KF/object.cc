// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/object.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include "common/convert/marker_set.h"
#include "common/fit/rigid_shape.h"
#include "common/io/mmm_model.h"
#include "common/io/mmm_object_model.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

constexpr int kFewestMarkers = 3;

// How many labels the configuration or a set has for markers of the model.
int CountKnown(const std::vector<MarkerPair>& pairs, const MarkerSequence& recording,
               const KinematicModel& model) {
  MarkerSet set;
  set.pairs = pairs;
  set.pairs = PairsInModel(set, model);
  return CountMappedMarkers(set, recording);
}

bool IsPersonsRecording(const Input& input, const ConverterConfig& config) {
  const Recording& recording = input.recording;
  if (!recording.format.starts_with("MMM") || recording.is_of_person) return true;
  const auto is_known = [&](const std::vector<MarkerPair>& pairs) {
    return CountKnown(pairs, recording.markers, *input.reference) >= kFewestMarkers;
  };
  if (is_known(config.marker_pairs)) return true;
  const std::vector<MarkerSet> sets = ReadMarkerSets(DataFile("marker_sets"));
  return std::any_of(sets.begin(), sets.end(),
                     [&](const MarkerSet& set) { return is_known(set.pairs); });
}

// Of a motion; any text may be its name.
std::string FileNameOf(const std::string& motion) {
  std::string name = motion.empty() ? "object" : motion;
  for (char& c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ||
                          c == '.' || static_cast<unsigned char>(c) >= 0x80;
    if (!is_plain) c = '_';
  }
  return name + ".xml";
}

bool IsFile(const std::string& path) {
  std::error_code failure;
  return fs::is_regular_file(path, failure);
}

void UseModel(const std::string& file, LoadedModel model, Input* input) {
  input->model = std::make_shared<const LoadedModel>(std::move(model));
  const std::vector<std::string>& warnings = input->model->warnings;
  input->warnings.insert(input->warnings.end(), warnings.begin(), warnings.end());
  input->model_file = file;
  input->reference = std::shared_ptr<const KinematicModel>(input->model, &input->model->model);
}

// Labels are the names of the model's markers, with or without MMM's prefix.
std::vector<MarkerPair> OwnPairs(const KinematicModel& model) {
  constexpr std::string_view kPrefix = "MARKER_";
  std::vector<MarkerPair> pairs = OwnMarkerSet(model).pairs;
  for (const ModelMarker& marker : model.markers()) {
    if (!marker.name.starts_with(kPrefix)) continue;
    pairs.push_back({marker.name.substr(kPrefix.size()), marker.name});
  }
  return pairs;
}

bool HasMarkers(const KinematicModel& model, const Input& input, const ConverterConfig& config) {
  const MarkerSequence& markers = input.recording.markers;
  return CountKnown(OwnPairs(model), markers, model) >= kFewestMarkers ||
         CountKnown(config.marker_pairs, markers, model) >= kFewestMarkers;
}

// The file that the motion names, if it is there and has markers to track.
bool UseNamedModel(const std::string& name, const ConverterConfig& config, Input* input) {
  const Recording& recording = input->recording;
  if (recording.model_path.empty()) return false;
  const std::string file =
      (fs::path(recording.file).parent_path() / recording.model_path).lexically_normal().string();
  if (!IsFile(file)) return false;
  LoadedModel model = ReadModelFile(file);
  if (!HasMarkers(model.model, *input, config)) {
    input->warnings.push_back(
        fmt::format("{}: the model of the motion {} has fewer than three of its markers ({}); one "
                    "is built from these",
                    file, name, fmt::join(recording.markers.labels(), ", ")));
    return false;
  }
  UseModel(file, std::move(model), input);
  return true;
}

KinematicModel ModelOf(const std::string& name, const RigidShape& shape,
                       const Recording& recording) {
  ModelDescription description;
  description.name = name;
  Segment root;
  root.name = "root_joint";
  description.segments.push_back(root);
  for (std::size_t i = 0; i < shape.labels.size(); ++i) {
    description.markers.push_back(
        {recording.markers.labels()[shape.labels[i]], 0, shape.p_OM.col(static_cast<int>(i))});
  }
  return KinematicModel(description);
}

void WarnOfUnplacedMarkers(const std::string& name, const RigidShape& shape, Input* input) {
  const std::vector<std::string>& labels = input->recording.markers.labels();
  for (int i = 0; i < static_cast<int>(labels.size()); ++i) {
    if (std::count(shape.labels.begin(), shape.labels.end(), i) > 0) continue;
    input->warnings.push_back(
        fmt::format("motion {}: marker {} is never seen with three others whose places are known, "
                    "and is left out of the model",
                    name, labels[i]));
  }
}

ObjectModel BuildModel(const std::string& file, const std::string& name, Input* input) {
  const Recording& recording = input->recording;
  const RigidShape shape = EstimateRigidShape(recording.markers);
  WarnOfUnplacedMarkers(name, shape, input);
  ObjectModel built;
  built.source = fmt::format("built from {} frames", shape.frames);
  built.distance = shape.distance;
  built.text = FormatObjectModel(
      ModelOf(name, shape, recording),
      fmt::format("Built from the markers of the motion {} of {}: {} frames, {:.2f} mm from the "
                  "markers (rms). Origin: mean of the markers. Axes: those of the world in the "
                  "first of the frames that show most markers.",
                  name, fs::path(recording.file).filename().string(), shape.frames,
                  1e3 * shape.distance));
  MmmModel model = ParseMmmModel(built.text, file);
  UseModel(file, {std::move(model.model), true, {}, std::move(model.warnings)}, input);
  return built;
}

ObjectModel FindModel(const ObjectRequest& request, const ConverterConfig& config, Input* input) {
  const std::string file_name = FileNameOf(request.name);
  if (!request.models.empty()) {
    const std::string file = (fs::path(request.models) / file_name).string();
    if (IsFile(file)) {
      LoadedModel model = ReadModelFile(file);
      if (!HasMarkers(model.model, *input, config)) {
        throw Error(fmt::format(
            "{}: has fewer than three of the motion's markers ({}); take it out of the folder to "
            "have one built from them",
            file, fmt::join(input->recording.markers.labels(), ", ")));
      }
      UseModel(file, std::move(model), input);
      return {"in " + request.models, "", 0};
    }
  }
  if (UseNamedModel(request.name, config, input)) return {"named by the motion", "", 0};
  return BuildModel((fs::path(request.new_models) / file_name).string(), request.name, input);
}

// A configuration is written for persons.
void AdaptToObject(const Input& input, ConverterConfig* config) {
  config->model_processor = "None";
  config->subject_file.clear();
  config->joints.clear();
  config->joint_set = "auto";
  const auto set = ReadOwnMarkerSet(*config);
  const std::vector<MarkerPair>& pairs = set ? set->pairs : config->marker_pairs;
  if (CountKnown(pairs, input.recording.markers, *input.reference) > 0) return;
  config->marker_pairs = OwnPairs(*input.reference);
}

}  // namespace

std::optional<ObjectModel> TakeObject(const ObjectRequest& request, Input* input,
                                      ConverterConfig* config) {
  std::optional<ObjectModel> object;
  if (request.has_model_given) {
    const int joints = input->reference->num_joints();
    if (joints > 0 && request.is_object) {
      throw Error(fmt::format("{}: --object: the model has {} joints; give one without, or none",
                              input->model_file, joints));
    }
    if (joints > 0) return std::nullopt;
    object = ObjectModel{"given", "", 0};
  } else {
    if (!request.is_object && IsPersonsRecording(*input, *config)) return std::nullopt;
    object = FindModel(request, *config, input);
  }
  AdaptToObject(*input, config);
  return object;
}

void CheckDeterminesPose(const Input& input, const MarkerMapping& mapping) {
  if (input.reference->num_joints() > 0) return;
  const int count = static_cast<int>(mapping.assignments.size());
  Eigen::Matrix3Xd places(3, count);
  std::vector<std::string> names;
  names.reserve(mapping.assignments.size());
  for (int i = 0; i < count; ++i) {
    const ModelMarker& marker = input.reference->markers()[mapping.assignments[i].marker];
    places.col(i) = marker.p_SM;
    names.push_back(marker.name);
  }
  constexpr double kOnALine = 1e-4;  // [m], what a marker system may resolve
  if (count >= kFewestMarkers && DistanceFromLine(places) > kOnALine) return;
  throw Error(
      fmt::format("{}: the markers that the recording has ({}) {}; the pose of a rigid object "
                  "needs three that do not stand on a line",
                  input.model_file, fmt::join(names, ", "),
                  count < kFewestMarkers ? "are too few" : "stand on a line"));
}

}  // namespace mmm_converter
