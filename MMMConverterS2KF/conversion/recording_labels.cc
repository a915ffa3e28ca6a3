// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/recording_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "MMMConverterS2KF/conversion/labelled_output.h"
#include "MMMConverterS2KF/conversion/person_calibration.h"
#include "common/convert/marker_set.h"
#include "common/label/label_recording.h"
#include "common/support/error.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kUsualMarkerSet = "kit53";

/// A name that a point can have.
struct PossibleName {
  std::string text;
  MarkerAssignment marker;  ///< its label does not count
  LabelIx stored;           ///< the recording's column that is called so; -1: none
};

/// Names, each model marker at most once.
class NameList {
 public:
  void Add(PossibleName name) {
    if (markers_.insert(name.marker.marker).second) names_.push_back(std::move(name));
  }
  bool empty() const { return names_.empty(); }

  /// The setup's assignments, and what LabelRecording asks for.
  void Give(TrackingSetup* setup, Labelling* labelling, LabelOptions* options) {
    std::sort(names_.begin(), names_.end(), [](const PossibleName& a, const PossibleName& b) {
      return a.marker.marker < b.marker.marker;
    });
    setup->mapping = MarkerMapping();
    for (const PossibleName& name : names_) {
      MarkerAssignment assignment = name.marker;
      assignment.label = LabelIx(static_cast<int>(labelling->names.size()));
      setup->mapping.assignments.push_back(assignment);
      labelling->names.push_back(name.text);
      options->stored.push_back(name.stored);
    }
  }

 private:
  std::vector<PossibleName> names_;
  std::set<int> markers_;
};

/// A recording whose labels are names, and how they match the model that is not scaled.
struct Labelled {
  Input input;
  TrackingSetup setup;
};

Labelled ReadLike(const InputRequest& request, const std::string& file, ConverterConfig config,
                  Warnings* warnings) {
  InputRequest like;
  like.file = file;
  like.reading.subject = request.reading.subject;
  like.model_file = request.model_file;
  like.marker_set = request.marker_set;
  Labelled labelled;
  labelled.input = ReadInput(like, {}, warnings);
  const WarningContext context(warnings, file);
  MatchModel(like, &labelled.input, &config);
  labelled.setup = MatchMarkers(LabelsOf(labelled.input.recording.markers, file),
                                labelled.input.reference, config, warnings);
  return labelled;
}

void AddLabels(const TrackingSetup& matched, const MarkerSequence& markers, bool are_stored,
               NameList* names) {
  for (const MarkerAssignment& one : matched.assignments()) {
    names->Add({markers.labels()[one.label], one, are_stored ? one.label : LabelIx()});
  }
}

// The marker set's labels of the subject's markers; of all markers, where there is no subject.
void AddMarkerSet(const Input& input, ConverterConfig config, const Subject* subject,
                  TrackingSetup* setup, NameList* names) {
  if (config.marker_pairs.empty() && config.marker_set == "auto") {
    config.marker_set = kUsualMarkerSet;
  }
  const KinematicModel& model = *input.reference;
  std::vector<MarkerPair> pairs = ResolveMarkerPairs(config, {}, model, &setup->marker_set);
  if (pairs.empty()) pairs = OwnMarkerSet(model).pairs;
  std::set<std::string> worn;
  if (subject != nullptr) {
    for (const MarkerOffset& offset : subject->offsets) worn.insert(offset.marker);
  }
  for (const MarkerPair& pair : pairs) {
    const MarkerIx marker(model.FindMarker(pair.target));
    if (marker < 0 || (subject != nullptr && !worn.contains(pair.target))) continue;
    names->Add({pair.source, {LabelIx(), marker, pair.noise_scale}, LabelIx()});
  }
}

// What the labelled recording tells of the person beyond the size.
void Calibrate(const Labelled& like, const ConverterConfig& config, Person* person,
               Warnings* warnings) {
  if (person->subject || config.model_processor == "None") return;
  const Recording& recording = like.input.recording;
  TrackingSetup setup = like.setup;
  ScaleToPerson(ScalingOf(*person, config), &setup);
  const std::string file = std::filesystem::path(recording.file).filename().string();
  try {
    const CalibrationResult result = CalibratePerson(
        *setup.model, setup.joints, {{file, &recording.markers, setup.assignments()}}, *person,
        SubjectName(like.input), warnings);
    person->subject = std::make_shared<Subject>(result.subject);
  } catch (const Error& error) {
    warnings->Add(
        fmt::format("{}: the person can't be calibrated on it and is known by the height only: {}",
                    recording.file, error.what()));
  }
}

Person FindLabelledPerson(const InputRequest& request, const LabelHints& hints, const Input& input,
                          const Labelled* like, const TrackingSetup* own,
                          const ConverterConfig& config, Warnings* warnings) {
  if (like != nullptr) {
    Person person =
        FindPerson(request.person, like->setup, like->input.recording, config, warnings);
    Calibrate(*like, config, &person, warnings);
    return person;
  }
  if (hints.repair) return FindPerson(request.person, *own, input.recording, config, warnings);
  return FindPersonOfPoints(request.person, *input.reference, input.recording, config, warnings);
}

// What there is before the points: whose they are, and the names that they can have.
FoundLabels FindNamesAndPerson(const InputRequest& request, const LabelHints& hints,
                               const Input& input, const ConverterConfig& config,
                               LabelOptions* options, Warnings* warnings) {
  const Recording& recording = input.recording;
  FoundLabels found;
  NameList names;
  TrackingSetup own;
  if (hints.repair) {
    own = MatchMarkers(LabelsOf(recording.markers, recording.file), input.reference, config,
                       warnings);
    AddLabels(own, recording.markers, true, &names);
    found.setup.marker_set = own.marker_set;
  }
  std::optional<Labelled> like;
  if (!hints.like.empty()) {
    like = ReadLike(request, hints.like, config, warnings);
    AddLabels(like->setup, like->input.recording.markers, false, &names);
    found.setup.marker_set = like->setup.marker_set;
  }
  found.person =
      FindLabelledPerson(request, hints, input, like ? &*like : nullptr, &own, config, warnings);
  const bool is_of_file = !found.person.subject_file.empty();
  if (is_of_file || names.empty()) {
    AddMarkerSet(input, config, is_of_file ? found.person.subject.get() : nullptr, &found.setup,
                 &names);
  }
  found.setup.joints = ResolveJoints(config, *input.reference);
  found.setup.model = std::make_shared<const KinematicModel>(
      ScaleModel(*input.reference, ScalingOf(found.person, config)));
  names.Give(&found.setup, &found.labelling, options);
  if (!hints.repair) options->stored.clear();
  return found;
}

}  // namespace

FoundLabels FindNames(const InputRequest& request, const Input& input,
                      const ConverterConfig& config, Warnings* warnings) {
  LabelOptions options;
  return FindNamesAndPerson(request, {}, input, config, &options, warnings);
}

FoundLabels FindLabels(const InputRequest& request, const LabelHints& hints, const Input& input,
                       const ConverterConfig& config, const std::function<bool(int, int)>& progress,
                       Warnings* warnings) {
  LabelOptions options;
  FoundLabels found = FindNamesAndPerson(request, hints, input, config, &options, warnings);
  const Recording& recording = input.recording;
  found.labelling =
      LabelRecording(found.setup, found.labelling.names, recording.markers, options, progress);
  const std::vector<std::string>& labels = recording.markers.labels();
  found.points = RelabelledPoints(found.labelling, labels, recording.markers.num_frames());
  found.changes = ChangesOf(found.labelling, labels);
  return found;
}

LabelReport RunLabelling(LabelRequest request, const std::function<bool(int, int)>& progress) {
  LabelReport report;
  report.output = request.output;
  Warnings* const warnings = &report.warnings;
  if (!request.output.empty()) CheckLabelledOutput(request.output);
  ConverterChoice choice = ChooseConverter(request.converter, warnings);
  OutputPlan outputs;
  NameInputs(request.input, &outputs);
  NameInputs(choice, &outputs);
  outputs.Read(request.hints.like);
  outputs.Rewrite(request.output, request.input.file);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  outputs.Check();
  request.input.reading.with_unlabelled = true;
  report.input = ReadInput(request.input, {}, warnings);
  const Recording& recording = report.input.recording;
  CheckKeepsRecording(request.output, recording);
  const WarningContext context(warnings, recording.file, recording.motion());
  MatchModel(request.input, &report.input, &choice.config);
  report.found =
      FindLabels(request.input, request.hints, report.input, choice.config, progress, warnings);
  return report;
}

}  // namespace mmm_converter
