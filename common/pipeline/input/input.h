// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/convert/named_markers.h"
#include "common/io/model_file.h"
#include "common/io/recording/recording.h"
#include "common/model/kinematic_model.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/person.h"
#include "common/support/output_plan.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// What the user says for the page that a clinician prints. Empty: what the recording says.
struct PatientRequest {
  std::string name;         ///< or number
  std::string condition;    ///< "barefoot", "with orthosis"
  std::string normal_file;  ///< bands of healthy gait, see ParseNormalBands
};

/// A recording and its person, as the user names them. Empty: a default.
struct InputRequest {
  std::string file;
  ReadRecordingOptions reading;
  std::optional<int> first_frame;                        ///< counted from 0
  std::optional<int> end_frame;                          ///< the frame behind the last
  std::optional<std::array<double, 2>> time_range = {};  ///< [s] where no frames are given
  std::string setup_file = {};  ///< of OpenSim, that what is empty was taken from
  std::string model_file;       ///< reference model, a URDF, or a model of OpenSim
  std::string marker_file;      ///< markers for a model of OpenSim
  std::string forces_file;      ///< of the ground, beside a recording without (ReadExternalLoads)
  std::string marker_set;       ///< file or name; comes before the configuration's
  PersonRequest person;
  PatientRequest patient;
  /// What was read of the file before, or made of arrays, and is then no file. Null: is read.
  WithWarnings<std::shared_ptr<const Recording>> recording = {};
  std::string events = {};  ///< of feet: "file" or "found"; empty: the file's where it has all
  std::string emg = {};     ///< labels of analog channels, or "all"; empty: none
};

struct NamedRecording;

/// What has been read for a request before: for all recordings of a batch, or for all motions of a
/// file. Null: is read.
struct ReadBefore {
  WithWarnings<std::shared_ptr<const LoadedModel>> model = {};
  WithWarnings<std::shared_ptr<const ConverterChoice>> choice = {};
  WithWarnings<std::shared_ptr<const Recording>> motion = {};      ///< one of several of the file
  WithWarnings<std::shared_ptr<const NamedRecording>> named = {};  ///< see LabelFirst
  std::set<std::string> opened = {};  ///< files that it was read of; see OpenedFiles
};

struct Input {
  Recording recording;  ///< the frames asked for
  int first_frame = 0;  ///< of them, counted from 0
  std::string model_file;
  std::string forces_file;                          ///< empty: the recording's own
  std::string smpl_model;                           ///< as in ReadRecordingOptions
  std::shared_ptr<const LoadedModel> model;         ///< of that file
  std::shared_ptr<const KinematicModel> reference;  ///< not scaled; see MatchModel
  /// What is calibrated is where clusters sit from their usual places: these stay in all
  /// recordings.
  bool keeps_usual_places = false;
  std::shared_ptr<const NamedMarkers>
      names;  ///< null: a marker set knows the labels; see MatchLabels
};

/// Says in the plan which files the request names.
void NameInputs(const InputRequest& request, OutputPlan* plan);

/// The file of the reference model.
std::string ModelFile(const InputRequest& request);

/// The model only; no recording.
/// @throws Error
Input ReadModel(const InputRequest& request, const ReadBefore& read_before, Warnings* warnings);

/// @throws Error where the model is one of OpenSim: `what` can't be done with it.
void CheckIsNoOsim(const Input& input, const std::string& what);

/// The model for several inputs: to be ReadBefore::model.
/// @throws Error
WithWarnings<std::shared_ptr<const LoadedModel>> ReadModelOnce(const InputRequest& request);

/// @throws Error
Input ReadInput(const InputRequest& request, const ReadBefore& read_before, Warnings* warnings);

/// The person of a model that was calibrated, where there is no other.
void UseModelsSubject(const Input& input, Person* person, Warnings* warnings);

/// ChooseConverter. @throws Error
ConverterChoice ChosenConverter(const ConverterRequest& request, const ReadBefore& read_before,
                                Warnings* warnings);

/// The request's marker set instead of the configuration's, where it names one.
void UseMarkerSet(const InputRequest& request, ConverterConfig* config);

/// Brings model and configuration together: UseMarkerSet; the reference gets the markers that the
/// configuration's marker set places; a model that is not of a person of 1 m is not scaled.
/// @throws Error as ReadMarkerSet and PlaceMarkers.
void MatchModel(const InputRequest& request, Input* input, ConverterConfig* config);

}  // namespace mmm_converter
