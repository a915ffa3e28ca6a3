// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/marker_mapping.h"
#include "common/pipeline/input/input.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// Whether a recording is an object's, and where its model may be.
struct ObjectRequest {
  bool is_object = false;  ///< the user says so
  bool is_person = false;  ///< the user says so
  std::string name;        ///< of the motion
  /// Folder of models, each called as its motion + ".xml"; empty: there is none yet.
  std::string models;
  /// Folder for models that are built from markers; empty: none may be built.
  std::string new_models;
  bool has_model_given = false;  ///< the input's reference model is one that the user named
};

/// Where the model of a rigid object is from.
struct ObjectModel {
  std::string source;   ///< "given", "named by the motion", "in MODELS", "built from N frames"
  std::string text;     ///< of the file to write at Input::model_file; empty: that is there already
  double distance = 0;  ///< of the markers from a built shape, root mean square [m]
  bool has_motions_name = false;  ///< the file is called as the motion: no other motion may have it
  std::string file;
  std::shared_ptr<const LoadedModel> model;  ///< of that file
  bool is_built() const { return !text.empty(); }
};

/// The recorded thing, where it is an object rather than a person: the user says so; the model
/// given has no joints; or none is given and the recording is an MMM motion that states neither a
/// height nor joints, with labels that no marker set of persons knows. Its model is the one given,
/// else the one of its name in request.models, else the file that the motion names if that is there
/// and can be tracked, else one that is built from the markers (EstimateRigidShape).
/// @throws Error
std::optional<ObjectModel> FindObject(const ObjectRequest& request, const Input& input,
                                      const ConverterConfig& config, Warnings* warnings);

/// All models of rigid objects in a folder, by name; others are left out with a warning.
/// @throws Error where there is none.
std::vector<ObjectModel> ReadObjectModels(const std::string& folder, Warnings* warnings);

/// Where the markers of a model without joints are, 3 x markers [m].
Eigen::Matrix3Xd PlacesOfMarkers(const KinematicModel& model);

/// The label of an object's marker: its name, without MMM's prefix.
std::string LabelOfMarker(const std::string& name);

/// Makes the object's model the input's.
void UseModel(const ObjectModel& object, Input* input);

/// A configuration without what it says of persons: scaling, subject, joints, a mapping to other
/// markers than those of the input's model.
ConverterConfig ConfigOfObject(const Input& input, ConverterConfig config);

/// Configurations know how far markers stray from a model of a person; on an object nothing moves
/// under them.
void TrustMarkersOfObject(MarkerMapping* mapping);

/// For messages: the motion needs a model, and none may be built.
std::string WhyNoModel(const std::string& file, const std::string& motion);

/// Where it is from, and how near a built one is to its markers.
std::string DescribeObjectModel(const ObjectModel& object);

/// @throws Error where the mapped markers of an object do not determine its pose.
void CheckDeterminesPose(const Input& input, const MarkerMapping& mapping);

/// Warns where an object's markers are so nearly on a line that they hardly tell turns about it.
/// residuals: markers x frames [m].
void WarnOfUnknownTurns(const Input& input, const MarkerMapping& mapping,
                        const Eigen::MatrixXd& residuals, Warnings* warnings);

}  // namespace mmm_converter
