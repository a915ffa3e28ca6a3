// SPDX-License-Identifier: MIT
#include "common/pipeline/object.h"

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
#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_object_model.h"
#include "common/model/marker_kinematics.h"
#include "common/model/posture.h"
#include "common/motion/marker_residuals.h"
#include "common/support/advice.h"
#include "common/support/data_directory.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

// How many labels the configuration or a set has for markers of the model.
int CountKnown(const std::vector<MarkerPair>& pairs, const MarkerSequence& recording,
               const KinematicModel& model) {
  MarkerSet set;
  set.pairs = pairs;
  set.pairs = PairsInModel(set, model);
  return CountMappedMarkers(set, recording.labels());
}

bool IsPersonsRecording(const Input& input, const ConverterConfig& config) {
  const Recording& recording = input.recording;
  if (!recording.mmm || recording.mmm->is_of_person) return true;
  const auto is_known = [&](const std::vector<MarkerPair>& pairs) {
    return CountKnown(pairs, recording.markers, *input.reference) >= kFewestMarkers;
  };
  if (is_known(config.marker_pairs) || is_known(OwnMarkerSet(*input.reference).pairs)) return true;
  if (const auto own = ReadOwnMarkerSet(config); own && is_known(own->pairs)) return true;
  const std::vector<MarkerSet> sets = ReadMarkerSets(DataFile("marker_sets"));
  return std::any_of(sets.begin(), sets.end(),
                     [&](const MarkerSet& set) { return is_known(set.pairs); });
}

// Of a motion; any text may be its name.
std::string FileNameOf(const std::string& motion) {
  constexpr std::size_t kLongest = 200;  // systems allow 255 bytes
  if (motion.size() > kLongest) {
    throw Error(
        fmt::format("the motion's name has {} bytes; a model is called as its motion, and may have "
                    "{}: give the motion a shorter name",
                    motion.size(), kLongest));
  }
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

// Labels are the names of the model's markers, with or without MMM's prefix.
std::vector<MarkerPair> OwnPairs(const KinematicModel& model) {
  std::vector<MarkerPair> pairs = OwnMarkerSet(model).pairs;
  for (const ModelMarker& marker : model.markers()) {
    const std::string label = LabelOfMarker(marker.name);
    if (label != marker.name) pairs.push_back({label, marker.name});
  }
  return pairs;
}

// Which labels are the model's markers: by the configuration where that knows three of them, else
// by their names. Empty: by neither.
std::vector<MarkerPair> PairsOfObject(const KinematicModel& model, const Input& input,
                                      const ConverterConfig& config) {
  MarkerSet set;
  if (const auto own = ReadOwnMarkerSet(config)) {
    set = *own;
  } else {
    set.pairs = config.marker_pairs;
  }
  for (const std::vector<MarkerPair>& pairs : {PairsInModel(set, model), OwnPairs(model)}) {
    if (CountKnown(pairs, input.recording.markers, model) >= kFewestMarkers) return pairs;
  }
  return {};
}

// Why the model can't be the object's; empty: it can.
std::string WhyNotItsModel(const LoadedModel& model, const Input& input,
                           const ConverterConfig& config) {
  if (model.model.num_joints() > 0) {
    return fmt::format("it has {} joints", model.model.num_joints());
  }
  if (!PairsOfObject(model.model, input, config).empty()) return "";
  return fmt::format("it has fewer than three of the motion's markers ({})",
                     FirstNames(input.recording.markers.labels()));
}

// The file that the motion names, if it is there and can be tracked.
std::optional<ObjectModel> FindNamedModel(const std::string& name, const ConverterConfig& config,
                                          const Input& input, Warnings* warnings) {
  const Recording& recording = input.recording;
  if (!recording.mmm || recording.mmm->model_path.empty()) return std::nullopt;
  const std::string file = (fs::path(recording.file).parent_path() / recording.mmm->model_path)
                               .lexically_normal()
                               .string();
  if (!IsFile(file)) return std::nullopt;
  std::string reason;
  try {
    Warnings of_model;
    auto model = std::make_shared<const LoadedModel>(ReadModelFile(file, &of_model));
    reason = WhyNotItsModel(*model, input, config);
    if (reason.empty()) {
      warnings->Append(of_model);
      return ObjectModel{"named by the motion", "", 0, false, file, std::move(model)};
    }
  } catch (const Error& error) {
    reason = error.what();
  }
  warnings->Add(
      fmt::format("{}, the model that the motion {} names, is not used: {}", file, name, reason));
  return std::nullopt;
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

void WarnOfUnplacedMarkers(const std::string& name, const RigidShape& shape,
                           const Recording& recording, Warnings* warnings) {
  const std::vector<std::string>& labels = recording.markers.labels();
  for (int i = 0; i < static_cast<int>(labels.size()); ++i) {
    if (std::count(shape.labels.begin(), shape.labels.end(), i) > 0) continue;
    warnings->Add(fmt::format(
        "motion {}: marker {} is left out of the model: it could not be placed by three "
        "others",
        name, labels[i]));
  }
}

constexpr std::string_view kBuilt = "Built from the markers of the motion";

// Only what an earlier run has built is replaced.
void CheckIsBuilt(const std::string& file) {
  constexpr std::size_t kStart = 1000;  // bytes; the comment is in front
  std::error_code failure;
  if (!fs::exists(file, failure)) return;
  if (IsFile(file) && ReadFileStart(file, kStart).find(kBuilt) != std::string::npos) return;
  throw Error(
      fmt::format("{}: was not built by this program, and would be replaced by a model that is; "
                  "give a folder for these ({} DIR)",
                  file, OptionText("object-models")));
}

RigidShape ShapeOf(const Recording& recording) {
  try {
    return EstimateRigidShape(recording.markers);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", recording.file, error.what()));
  }
}

ObjectModel BuildModel(const std::string& file, const std::string& name, const Input& input,
                       Warnings* warnings) {
  CheckIsBuilt(file);
  const Recording& recording = input.recording;
  const RigidShape shape = ShapeOf(recording);
  WarnOfUnplacedMarkers(name, shape, recording, warnings);
  ObjectModel built;
  built.has_motions_name = true;
  built.source = fmt::format("built from {} frames", shape.frames);
  built.distance = shape.distance;
  built.text = FormatObjectModel(
      ModelOf(name, shape, recording),
      fmt::format("{} {} of {}: {} frames, {:.2f} mm from the markers (rms). Origin: mean of the "
                  "markers. Axes: those of the world in the first of the frames that show most "
                  "markers.",
                  kBuilt, name, fs::path(recording.file).filename().string(), shape.frames,
                  1e3 * shape.distance));
  built.file = file;
  built.model = std::make_shared<const LoadedModel>(
      LoadedModel{ParseMmmModel(built.text, file, warnings), true, {}});
  return built;
}

ObjectModel FindModel(const ObjectRequest& request, const ConverterConfig& config,
                      const Input& input, Warnings* warnings) {
  const std::string file_name = FileNameOf(request.name);
  if (!request.models.empty()) {
    const std::string file = (fs::path(request.models) / file_name).string();
    if (IsFile(file)) {
      auto model = std::make_shared<const LoadedModel>(ReadModelFile(file, warnings));
      const std::string reason = WhyNotItsModel(*model, input, config);
      if (!reason.empty()) {
        throw Error(fmt::format("{}: {}; take it out of the folder to have one built from them",
                                file, reason));
      }
      return {"in " + request.models, "", 0, true, file, std::move(model)};
    }
  }
  if (auto named = FindNamedModel(request.name, config, input, warnings)) return *named;
  if (request.new_models.empty()) {
    throw Error(WhyNoModel(input.recording.file, request.name));
  }
  return BuildModel((fs::path(request.new_models) / file_name).string(), request.name, input,
                    warnings);
}

// Of the markers that are tracked, in the model [m].
Eigen::Matrix3Xd PlacesOf(const Input& input, const MarkerMapping& mapping) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(mapping.assignments.size()));
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const MarkerAssignment& assignment = mapping.assignments[static_cast<std::size_t>(i)];
    places.col(i) = input.reference->markers()[assignment.marker].p_SM;
  }
  return places;
}

}  // namespace

std::string WhyNoModel(const std::string& file, const std::string& motion) {
  return fmt::format(
      "{}: the motion {} is of a rigid object without a model, and there is no folder for one that "
      "is built (convert {} DIR)",
      file, motion, OptionText("object-models"));
}

std::optional<ObjectModel> FindObject(const ObjectRequest& request, const Input& input,
                                      const ConverterConfig& config, Warnings* warnings) {
  if (request.has_model_given) {
    const int joints = input.reference->num_joints();
    if (joints > 0 && request.is_object) {
      throw Error(fmt::format("{}: {}: the model has {} joints; give one without, or none",
                              input.model_file, OptionText("object"), joints));
    }
    if (joints > 0) return std::nullopt;
    return ObjectModel{"given", "", 0, false, input.model_file, input.model};
  }
  const bool is_person = request.is_person || IsPersonsRecording(input, config);
  if (!request.is_object && is_person) return std::nullopt;
  return FindModel(request, config, input, warnings);
}

std::string LabelOfMarker(const std::string& name) {
  constexpr std::string_view kPrefix = "MARKER_";
  return name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : name;
}

Eigen::Matrix3Xd PlacesOfMarkers(const KinematicModel& model) {
  std::vector<MarkerIx> all;
  for (std::size_t m = 0; m < model.markers().size(); ++m) all.emplace_back(static_cast<int>(m));
  const MarkerKinematics kinematics(model, {}, all);
  MarkerJacobian at = kinematics.MakeJacobian();
  kinematics.ComputeMarkers(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), Eigen::VectorXd(),
                            &at);
  return at.p_WM;
}

std::vector<ObjectModel> ReadObjectModels(const std::string& folder, Warnings* warnings) {
  constexpr double kOffLine = 0.01;  // [m]
  std::error_code failure;
  (void)NamesIn(folder, &failure);
  if (failure) throw Error(fmt::format("{}: can't be read: {}", folder, failure.message()));
  std::string why_not;  // of the first that is none
  std::vector<ObjectModel> models;
  for (const std::string& file : FilesIn(folder, ".xml")) {
    if (!IsFile(file)) continue;
    try {
      Warnings of_model;
      auto model = std::make_shared<const LoadedModel>(ReadModelFile(file, &of_model));
      if (model->model.num_joints() > 0 || model->model.markers().size() < kFewestMarkers ||
          DistanceFromLine(PlacesOfMarkers(model->model)) < kOffLine) {
        throw Error(fmt::format(
            "{}: an object that is found among points has no joints, and three markers or more "
            "that are no line",
            file));
      }
      warnings->Append(of_model);
      models.push_back({"in " + folder, "", 0, true, file, std::move(model)});
    } catch (const Error& error) {
      if (why_not.empty()) why_not = fmt::format("; {}", error.what());
      warnings->Add(fmt::format("left out: {}", error.what()));
    }
  }
  if (!models.empty()) return models;
  throw Error(
      fmt::format("{}: there is no model of a rigid object (*.xml) here{}", folder, why_not));
}

void UseModel(const ObjectModel& object, Input* input) {
  if (input->model == object.model) return;  // with the markers that a marker set places
  input->model_file = object.file;
  input->model = object.model;
  input->reference = std::shared_ptr<const KinematicModel>(input->model, &input->model->model);
}

ConverterConfig ConfigOfObject(const Input& input, ConverterConfig config) {
  config.model_processor = "None";
  config.subject_file.clear();
  config.joints.clear();
  config.joint_set = "auto";
  const std::vector<MarkerPair> pairs = PairsOfObject(*input.reference, input, config);
  config.marker_pairs = pairs.empty() ? OwnPairs(*input.reference) : pairs;
  return config;
}

void TrustMarkersOfObject(MarkerMapping* mapping) {
  // With a tenth, KIT's recordings of objects have innovations of the size that the filter expects
  // (NIS over its degrees of freedom 0.2 to 1.3; with all of it, 0.01).
  constexpr double kNoiseOfObjects = 0.1;
  for (MarkerAssignment& assignment : mapping->assignments) {
    assignment.noise_scale *= kNoiseOfObjects;
  }
}

std::string DescribeObjectModel(const ObjectModel& object) {
  std::string text = "model " + object.source;
  if (object.is_built()) {
    text += fmt::format(", {:.2f} mm from the markers (rms)", 1e3 * object.distance);
  }
  return text;
}

void CheckDeterminesPose(const Input& input, const MarkerMapping& mapping) {
  if (input.reference->num_joints() > 0) return;
  const auto count = static_cast<int>(mapping.assignments.size());
  std::vector<std::string> names;
  names.reserve(mapping.assignments.size());
  for (const MarkerAssignment& assignment : mapping.assignments) {
    names.push_back(input.reference->markers()[assignment.marker].name);
  }
  constexpr double kOnALine = 1e-4;  // [m], what a marker system may resolve
  if (count >= kFewestMarkers && DistanceFromLine(PlacesOf(input, mapping)) > kOnALine) return;
  throw Error(
      fmt::format("{}: the markers that the recording has ({}) {}; the pose of a rigid object "
                  "needs three that do not stand on a line",
                  input.model_file, fmt::join(names, ", "),
                  count < kFewestMarkers ? "are too few" : "stand on a line"));
}

void WarnOfUnknownTurns(const Input& input, const MarkerMapping& mapping,
                        const Eigen::MatrixXd& residuals, Warnings* warnings) {
  constexpr double kHardlyTold = 0.05;  // [rad]
  const Eigen::Matrix3Xd places = PlacesOf(input, mapping);
  const double beside_line = DistanceFromLine(places);
  const double distance = SummarizeResiduals(residuals).mean;
  if (distance > kMostStray * RadiusOf(places)) return;  // the verdict says so
  if (distance > kHardlyTold * beside_line) {
    warnings->Add(
        fmt::format("{}: the markers are {:.1f} mm (root mean square) beside a line, and {:.1f} "
                    "mm from their places on average: turns about that line are hardly known, "
                    "to about {:.0f} degrees",
                    input.model_file, 1e3 * beside_line, 1e3 * distance,
                    distance / beside_line * 180 / EIGEN_PI));
  }
}

}  // namespace mmm_converter
