// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/convert/motion_converter.h"
#include "common/judge/verdict.h"
#include "common/pipeline/exporters.h"
#include "common/pipeline/input/converter_choice.h"
#include "common/pipeline/input/input.h"
#include "common/pipeline/input/person.h"
#include "common/pipeline/object.h"
#include "common/pipeline/person_calibration.h"
#include "common/pipeline/recording_labels.h"
#include "common/study/conversion_figures.h"
#include "common/support/warnings.h"

namespace mmm_converter {

struct Emg;
struct GroundStudy;
struct NormalBands;
struct RecordedForces;
struct StoredEvents;

/// To which robot a motion is brought. No file: to none.
struct RobotRequest {
  std::string file;                   ///< URDF or MJCF
  std::string map_file;               ///< see ReadBodyMapChoice
  std::optional<double> sole_height;  ///< of the last ankle joint above the sole [m]
  std::string sole;                   ///< "LENGTH,WIDTH,HEIGHT" [m], "meshes" or "shapes"
  std::string hold;                   ///< joints, see HoldJoints
  std::string weights;                ///< of aims, see ParseAimWeights
  std::vector<std::string> objects;   ///< beside the person, see ReadObjects
  std::optional<double> export_rate;  ///< [Hz]
  std::string order;                  ///< see ParseRobotOrder; empty: none is given
};

/// What the user asked for. Empty: a default.
struct ConversionRequest {
  InputRequest input;
  ConverterRequest converter;
  std::string output;                     ///< input stem + "_mmm.xml", beside the input
  std::string output_format;              ///< "2.0" or "1.0"; empty: what the configuration says
  std::string motion_name;                ///< to write
  std::string model_path;                 ///< to write, as it is
  bool self_calibrate = false;            ///< estimate the person from the recording itself
  std::string subject_output;             ///< also write the estimated subject
  std::string model_output;               ///< also write the subject's model
  ExportFiles exports;                    ///< for other programs
  std::vector<std::string> more_outputs;  ///< that the caller writes
  bool label = false;                     ///< find the names of points first
  LabelHints label_hints;                 ///< of these
  bool is_object = false;                 ///< of a rigid object, whatever the file says
  bool keeps_covariances = false;         ///< also where no export is of them
  /// Folder of the models of objects; those that it lacks are written there.
  std::string object_models;
  bool builds_models = true;               ///< of objects that have none
  std::vector<std::string> other_objects;  ///< live: models of rigid objects that are there too
  RobotRequest robot;  ///< for who brings the motion to one: retarget, batch and live
};

/// All that is decided before the first frame is tracked.
struct ConversionPlan {
  Input input;
  std::optional<FoundLabels> labels;  ///< where the input has got its labels by the body
  ConverterChoice converter;
  Person person;
  std::optional<CalibrationResult> calibration;  ///< of the person, by this recording
  std::optional<ObjectModel> object;             ///< what is tracked, where it is no person
  TrackingSetup setup;
  std::string output, output_format, motion_name;
  std::string subject_output, model_output;  ///< empty: not written
  bool self_calibrates = false;              ///< before it is tracked
  bool keeps_covariances = false;
  bool takes_covariances = false;                ///< where the converter has them
  std::shared_ptr<const RecordedForces> forces;  ///< of plates, where the model has feet
  std::shared_ptr<const StoredEvents> events;    ///< of feet; null: the file has none
  std::shared_ptr<const Emg> emg;                ///< null: none is asked for
  std::set<std::string> opened;                  ///< files; see OpenedFiles
  PatientRequest patient;
  std::shared_ptr<const NormalBands> normal;  ///< null: no file was named
  Warnings warnings;
};

/// A plan that has been carried out.
struct ConversionReport {
  ConversionPlan plan;
  ConversionResult result;
  ConversionFigures figures;
  Verdict verdict;
  std::shared_ptr<const GroundStudy> ground;  ///< where there are plates, or an export is of it
  Warnings warnings;                          ///< those of the plan, and what was noticed since
};

/// The recording's label of an assignment.
const std::string& LabelOf(const ConversionPlan& plan, int assignment);

/// Names the recording's points where the request asks for it (LabelPoints), which is to be done
/// before it is planned. The recording is then ReadBefore::named.
/// @throws Error
ReadBefore LabelFirst(const ConversionRequest& request, ReadBefore read_before,
                      const std::function<bool(int, int)>& progress);

/// Matches labels to markers, finds the person of the input's recording and scales the model: the
/// plan's setup and person, of its input, configuration and object.
/// @throws Error
void PlanBody(const ConversionRequest& request, const MarkerLabels& labels, ConversionPlan* plan);

/// Reads the recording, the model and the configuration, matches the markers, finds the person or
/// the object, and what is written where.
/// @throws Error
ConversionPlan PlanConversion(const ConversionRequest& request, const ReadBefore& read_before);

/// Before any further work, of one motion or of all of a file.
/// @throws Error where an output is a file that is read, two are the same, or one can't be written.
void CheckOutputs(const ConversionRequest& request,
                  const std::vector<const ConversionPlan*>& plans);

/// Calibrates where that is planned, tracks and judges; writes nothing. progress(done, all):
/// frames; may be empty; returning false ends it with an Error.
/// @throws Error
ConversionReport CarryOut(ConversionPlan plan, const std::function<bool(int, int)>& progress);

/// The figures and the verdict of a report that has all else.
void MeasureAndJudge(ConversionReport* report);

/// PlanConversion, CheckOutputs, CarryOut and StudyExports. read_before: by LabelFirst.
ConversionReport RunConversion(const ConversionRequest& request, const ReadBefore& read_before,
                               const std::function<bool(int, int)>& progress);

/// Writes the model of an object, where that is new. @throws Error
void WriteObjectModel(const ConversionPlan& plan);

/// Writes the motion and what else is asked for.
/// @throws Error; each file is then as it was before, or whole.
void WriteConversion(const ConversionRequest& request, ConversionReport* report);

}  // namespace mmm_converter
