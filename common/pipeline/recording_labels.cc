// SPDX-License-Identifier: MIT
#include "common/pipeline/recording_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/convert/exchanged_sides.h"
#include "common/convert/marker_set.h"
#include "common/convert/named_markers.h"
#include "common/convert/tracking_setup.h"
#include "common/fit/height_estimate.h"
#include "common/fit/posture_search.h"
#include "common/judge/evidence.h"
#include "common/judge/label_verdict.h"
#include "common/label/track/label_recording.h"
#include "common/math/statistics.h"
#include "common/motion/marker_sequence.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/pipeline/labelled_output.h"
#include "common/pipeline/object.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/folder.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"
#include "common/support/units.h"
#include "common/support/warnings.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3Xd;

/// The recording with left and right labels exchanged, where they are the wrong way round all along
/// (FindExchangedSides), which a warning says: a tracker that begins with the wrong side could mend
/// one part and not another. setup: its labels are numbers of names; stored: the recording's column
/// that is called like each name, -1: none.
std::optional<MarkerSequence> ExchangeSides(TrackingSetup setup, const std::vector<LabelIx>& stored,
                                            const MarkerSequence& recording, Warnings* warnings) {
  std::vector<MarkerAssignment>& assignments = setup.mapping.assignments;
  for (MarkerAssignment& one : assignments) one.label = stored[one.label];
  std::erase_if(assignments, [](const MarkerAssignment& one) { return one.label < 0; });
  const auto sides = FindExchangedSides(setup, recording);
  if (!sides) return std::nullopt;
  warnings->Add(fmt::format(
      "left and right labels of {} are exchanged, by which markers come from {:.0f} to {:.0f} mm "
      "from the model; if it is the coordinates that are mirrored, mend these instead",
      sides->part, kMillimetres * sides->distance, kMillimetres * sides->exchanged_distance));
  return WithLabelsExchanged(*sides, recording);
}

/// The recording with labels whose names the body contradicts under the names of where they are, as
/// far as these are contradicted, too: sides, pairs. A warning tells. Nothing where there are none.
/// named: the recording's labels by their names alone; understood: as the body bears them out.
std::optional<MarkerSequence> ExchangeNames(const NamedMarkers& named,
                                            const NamedMarkers& understood,
                                            const MarkerSequence& recording, Warnings* warnings) {
  NamedMarkers exchanged;
  std::map<int, int> name_of;  // by label, the one whose name it gets
  for (int i = 0; i < static_cast<int>(understood.labels.size()); ++i) {
    const NamedLabel& one = understood.labels[i];
    if (!one.is_contradicted || one.marker.empty()) continue;
    const auto owner =
        std::find_if(named.labels.begin(), named.labels.end(), [&](const NamedLabel& other) {
          return !other.marker.empty() && other.landmark == one.landmark;
        });
    if (owner != named.labels.end()) name_of[i] = static_cast<int>(owner - named.labels.begin());
  }
  // A name that its own label keeps is not free.
  while (std::erase_if(name_of, [&](const auto& one) { return !name_of.contains(one.second); })) {
  }
  std::vector<std::string> labels = recording.labels();
  for (const auto& [label, name] : name_of) {
    labels[label] = recording.labels()[name];
    if (label != name) exchanged.labels.push_back(understood.labels[label]);
  }
  const bool is_twice = std::set(labels.begin(), labels.end()).size() < labels.size();
  if (exchanged.labels.empty() || is_twice) return std::nullopt;
  warnings->Add(
      fmt::format("labels that are not where their names say get the names of where they are: {}",
                  FirstNames(DescribeContradictions(exchanged), 6)));
  MarkerSequence renamed(labels, recording.num_frames(), recording.rate(), recording.first_time());
  for (int k = 0; k < recording.num_frames(); ++k) renamed.frame(k) = recording.frame(k);
  return renamed;
}

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

  /// The setup's assignments, and what LabelRecording asks for. prefix: of the names.
  void AssignTo(const std::string& prefix, TrackingSetup* setup, Labelling* labelling,
                LabelOptions* options) {
    std::sort(names_.begin(), names_.end(), [](const PossibleName& a, const PossibleName& b) {
      return a.marker.marker < b.marker.marker;
    });
    setup->mapping = MarkerMapping();
    for (const PossibleName& name : names_) {
      MarkerAssignment assignment = name.marker;
      assignment.label = LabelIx(static_cast<int>(labelling->names.size()));
      setup->mapping.assignments.push_back(assignment);
      labelling->names.push_back(prefix + name.text);
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
  labelled.setup = MatchLabels(LabelsOf(labelled.input.recording.markers, file), &labelled.input,
                               config, warnings);
  return labelled;
}

void AddLabels(const TrackingSetup& matched, const MarkerSequence& markers, bool are_stored,
               NameList* names) {
  for (const MarkerAssignment& one : matched.assignments()) {
    names->Add({markers.labels()[one.label], one, are_stored ? one.label : LabelIx()});
  }
}

// The marker set's labels of the subject's markers; of all markers, where there is no subject.
// Returns the marker set's name.
std::string AddMarkerSet(const Input& input, ConverterConfig config, const Subject* subject,
                         NameList* names) {
  std::string marker_set;
  const KinematicModel& model = *input.reference;
  const bool is_free = config.marker_pairs.empty() && config.marker_set == "auto";
  if (is_free && !model.coordinates()) config.marker_set = kUsualMarkerSet;
  std::vector<MarkerPair> pairs;
  if (!is_free || !model.coordinates()) {
    pairs = ResolveMarkerPairs(config, {}, model, &marker_set);
  }
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
  return marker_set;
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
                          const Labelled* like, const MatchedLabels& own,
                          const ConverterConfig& config, Warnings* warnings) {
  if (like != nullptr) {
    Person person = FindPerson(request.person, like->setup, like->input.recording, config, warnings,
                               like->input.names.get());
    Calibrate(*like, config, &person, warnings);
    return person;
  }
  if (hints.repair) {
    return FindPerson(request.person, own.setup, input.recording, config, warnings,
                      own.names.get());
  }
  return FindPersonOfPoints(request.person, *input.reference, input.recording, config, warnings);
}

// Names of bodies are read back as subjects, whose case does not count.
void CheckName(const OtherBody& body, const std::string& first, const FoundLabels& found) {
  if (body.name.empty() || body.name.starts_with('*')) {
    throw Error(fmt::format("{}: the name \"{}\" can't stand before labels; give it another one",
                            body.file, body.name));
  }
  std::string same = EqualIgnoringCase(first, body.name) ? "the first person" : "";
  for (const OtherBody& other : found.others) {
    if (EqualIgnoringCase(other.name, body.name)) same = other.file;
  }
  if (same.empty()) return;
  throw Error(
      fmt::format("{}: {} is called {}, too, and so would be its labels; give it another "
                  "name",
                  body.file, same, body.name));
}

void AddPerson(const std::string& file, const std::string& first, const Input& input,
               const ConverterConfig& config, FoundLabels* found, LabelScene* scene,
               LabelOptions* options, Warnings* warnings) {
  if (file.empty()) throw Error("the file of another person has no name");
  PersonRequest request;
  request.subject_file = file;
  const Person person =
      FindPersonOfPoints(request, *input.reference, input.recording, config, warnings);
  OtherBody other;
  other.name = person.subject->name;
  other.file = file;
  CheckName(other, first, *found);
  TrackingSetup setup;
  NameList names;
  setup.marker_set = AddMarkerSet(input, config, person.subject.get(), &names);
  setup.joints = found->setup.joints;
  setup.model = std::make_shared<const KinematicModel>(
      ScaleModel(*input.reference, ScalingOf(person, config)));
  other.first_name = static_cast<int>(found->labelling.names.size());
  names.AssignTo(other.name + ":", &setup, &found->labelling, options);
  other.end_name = static_cast<int>(found->labelling.names.size());
  found->others.push_back(std::move(other));
  scene->persons.push_back(std::move(setup));
}

void AddObject(const ObjectModel& model, const std::string& first, FoundLabels* found,
               LabelScene* scene) {
  OtherBody other;
  other.name = std::filesystem::path(model.file).stem().string();
  other.file = model.file;
  other.is_object = true;
  CheckName(other, first, *found);
  LabelObject object;
  object.p_OM = PlacesOfMarkers(model.model->model);
  other.first_name = static_cast<int>(found->labelling.names.size());
  std::set<std::string> labels;
  for (const ModelMarker& marker : model.model->model.markers()) {
    const std::string label = LabelOfMarker(marker.name);
    if (!labels.insert(label).second) {
      throw Error(fmt::format("{}: two markers would have the label {}", model.file, label));
    }
    object.names.push_back(static_cast<int>(found->labelling.names.size()));
    found->labelling.names.push_back(other.name + ":" + label);
  }
  other.end_name = static_cast<int>(found->labelling.names.size());
  found->others.push_back(std::move(other));
  scene->objects.push_back(std::move(object));
}

void CheckAreFree(const std::vector<std::string>& names, const std::set<std::string>& taken,
                  const std::string& file) {
  for (const std::string& name : names) {
    if (!taken.contains(name)) continue;
    throw Error(fmt::format(
        "{}: has another point {}, which is computed or another subject's and stays; give the "
        "points other names ({} RECORDING or {} NAME), the person another name, or "
        "write a .trc",
        file, name, OptionText("like"), OptionText("marker-set")));
  }
}

// What there is before the points: whose they are, and the names that they can have. own: gets the
// names by which the recording's own labels were understood.
FoundLabels FindNamesAndPerson(const InputRequest& request, const LabelHints& hints,
                               const Input& input, const ConverterConfig& config, LabelScene* scene,
                               LabelOptions* options, Warnings* warnings,
                               std::shared_ptr<const NamedMarkers>* own_names = nullptr) {
  const Recording& recording = input.recording;
  FoundLabels found;
  NameList names;
  std::shared_ptr<const KinematicModel> reference = input.reference;
  MatchedLabels own;
  if (hints.repair) {
    own = MatchLabels(LabelsOf(recording.markers, recording.file), input, config, warnings);
    reference = own.setup.model;
    AddLabels(own.setup, recording.markers, true, &names);
    found.setup.marker_set = own.setup.marker_set;
    if (own_names != nullptr) *own_names = own.names;
  }
  std::optional<Labelled> like;
  if (!hints.like.empty()) {
    like = ReadLike(request, hints.like, config, warnings);
    reference = like->input.reference;
    AddLabels(like->setup, like->input.recording.markers, false, &names);
    found.setup.marker_set = like->setup.marker_set;
  }
  found.person =
      FindLabelledPerson(request, hints, input, like ? &*like : nullptr, own, config, warnings);
  UseModelsSubject(input, &found.person, warnings);
  const bool is_of_file = !found.person.subject_file.empty();
  if (is_of_file || names.empty()) {
    const std::string marker_set =
        AddMarkerSet(input, config, is_of_file ? found.person.subject.get() : nullptr, &names);
    if (found.setup.marker_set.empty()) found.setup.marker_set = marker_set;
  }
  found.setup.joints = ResolveJoints(config, *input.reference);
  found.reference = reference;
  found.setup.model = std::make_shared<const KinematicModel>(
      ScaleModel(*reference, ScalingOf(found.person, config)));
  const std::string name = found.person.subject ? found.person.subject->name : SubjectName(input);
  if (!hints.other_persons.empty()) found.prefix = name + ":";
  names.AssignTo(found.prefix, &found.setup, &found.labelling, options);
  scene->persons.push_back(found.setup);
  for (const std::string& file : hints.other_persons) {
    AddPerson(file, name, input, config, &found, scene, options, warnings);
  }
  if (!hints.object_models.empty()) {
    for (const ObjectModel& model : ReadObjectModels(hints.object_models, warnings)) {
      AddObject(model, name, &found, scene);
    }
  }
  if (!hints.repair) options->stored.clear();
  CheckAreFree(found.labelling.names, hints.taken, recording.file);
  return found;
}

constexpr int kFrames = 24, kFewestPoints = 10, kAttempts = 4;

/// The markers that points have the names of, and columns of these points.
struct NamedMarkersOf {
  std::vector<MarkerIx> markers;
  std::vector<LabelIx> columns;
  std::vector<std::string> names;
  Eigen::VectorXd noise_scale;
};

NamedMarkersOf FindMarkers(const FoundLabels& found, const MarkerSequence& named) {
  NamedMarkersOf of;
  std::vector<double> scales;
  for (const MarkerAssignment& one : found.setup.assignments()) {
    const std::string name = found.labelling.names[one.label].substr(found.prefix.size());
    const int column = named.FindLabel(name);
    if (column < 0) continue;
    of.markers.push_back(one.marker);
    of.columns.emplace_back(column);
    of.names.push_back(name);
    scales.push_back(one.noise_scale);
  }
  of.noise_scale = Eigen::Map<Eigen::VectorXd>(scales.data(), std::ssize(scales));
  return of;
}

/// Frames x markers [m]; NaN: not seen, or the frame shows too few. fit: gets the frames that show
/// enough; may be null.
Eigen::MatrixXd Distances(const FoundLabels& found, const NamedMarkersOf& of,
                          const MarkerSequence& named, FittedLabels* fit) {
  const MarkerKinematics kinematics(*found.setup.model, found.setup.joints, of.markers);
  MarkerJacobian at = kinematics.MakeJacobian();
  PostureSearch search(kinematics);
  PostureFitOptions options;
  options.robust_distance = 0.1;
  Eigen::MatrixXd distances = Eigen::MatrixXd::Constant(kFrames, kinematics.num_markers(), kNaN);
  std::vector<int> told;
  std::vector<Posture> postures;
  for (int i = 0; i < kFrames; ++i) {
    const int k = (2 * i + 1) * named.num_frames() / (2 * kFrames);
    const Matrix3Xd z = named.frame(k)(Eigen::all, of.columns);
    if (z.row(0).array().isFinite().count() < kFewestPoints) continue;
    Posture posture;
    search.Assemble(z, of.noise_scale, options, kAttempts, &posture);
    kinematics.ComputeMarkers(posture.position, posture.orientation.toRotationMatrix(),
                              posture.joint_angles, &at);
    distances.row(i) = (z - at.p_WM).colwise().norm();
    told.push_back(k);
    postures.push_back(std::move(posture));
  }
  if (fit != nullptr) {
    const int n = static_cast<int>(told.size());
    fit->frames = MarkerSequence(named.labels(), n, named.rate(), 0);
    for (int i = 0; i < n; ++i) fit->frames.frame(i) = named.frame(told[i]);
    fit->trajectory.postures = std::move(postures);
    fit->trajectory.rate = named.rate();
  }
  return distances;
}

/// The mean distance of a marker; NaN: it is never seen.
double MeanDistance(const Eigen::MatrixXd& distances, Eigen::Index marker) {
  return Mean({distances.col(marker).data(), static_cast<std::size_t>(distances.rows())});
}

}  // namespace

std::vector<std::string> FilesOf(const LabelHints& hints) {
  std::vector<std::string> files = hints.other_persons;
  if (!hints.like.empty()) files.push_back(hints.like);
  if (hints.object_models.empty()) return files;
  for (std::string& model : FilesIn(hints.object_models, ".xml")) files.push_back(std::move(model));
  return files;
}

FoundLabels FindNames(const InputRequest& request, const Input& input,
                      const ConverterConfig& config, Warnings* warnings) {
  LabelScene scene;
  LabelOptions options;
  return FindNamesAndPerson(request, {}, input, config, &scene, &options, warnings);
}

FoundLabels FindLabels(const InputRequest& request, const LabelHints& hints, const Input& input,
                       const ConverterConfig& config, const std::function<bool(int, int)>& progress,
                       Warnings* warnings) {
  LabelHints known = hints;
  if (hints.like.empty() && !hints.has_others()) {
    known.repair |= AreAllNamed(LabelsOf(input.recording.markers), input, config);
  }
  if (hints.repair && hints.has_others()) {
    throw Error("labels can be repaired for one person at a time, without objects");
  }
  LabelScene scene;
  LabelOptions options;
  Warnings of_exchange = warnings != nullptr ? *warnings : Warnings();
  std::shared_ptr<const NamedMarkers> own_names;
  FoundLabels found =
      FindNamesAndPerson(request, known, input, config, &scene, &options, warnings, &own_names);
  const std::vector<std::string>& labels = input.recording.markers.labels();
  std::optional<Input> exchanged;
  if (hints.repair) {
    const MarkerSequence& stored = input.recording.markers;
    std::optional<MarkerSequence> right;
    if (own_names != nullptr) {
      const NamedMarkers by_name = ComposeNamedMarkers(LabelsOf(stored, input.recording.file),
                                                       *input.reference, ShippedLandmarks());
      right = ExchangeNames(by_name, *own_names, stored, &of_exchange);
    }
    if (!right) right = ExchangeSides(found.setup, options.stored, stored, &of_exchange);
    if (right) {
      exchanged = input;
      exchanged->recording.markers = std::move(*right);
      scene = {};
      options = {};
      // What was said of the wrong sides does not hold.
      if (warnings != nullptr) *warnings = std::move(of_exchange);
      found = FindNamesAndPerson(request, known, *exchanged, config, &scene, &options, warnings);
      found.has_exchanged_sides = true;
    }
  }
  const MarkerSequence& markers = (exchanged ? *exchanged : input).recording.markers;
  found.is_repair = known.repair;
  found.labelling = LabelRecording(scene, found.labelling.names, markers, options, progress);
  if (known.repair && found.person.subject == nullptr) {
    // Who asks for a repair has labels that may be wrong all along, as far as the body can tell.
    constexpr double kWornElsewhere = 0.1;  // [m]
    KeepLabelsOfAllFrames(markers.labels(),
                          hints.repair ? NamesThatFit(found, markers, kWornElsewhere)
                                       : std::set<std::string>(labels.begin(), labels.end()),
                          &found.labelling);
  }
  found.points = RelabelledPoints(found.labelling, labels, markers.num_frames());
  found.changes = ChangesOf(found.labelling, labels);
  return found;
}

LabelReport LabelPoints(const LabelRequest& request, const ReadBefore& read_before,
                        const std::function<bool(int, int)>& progress) {
  LabelReport report;
  report.output = request.output;
  Warnings* const warnings = &report.warnings;
  InputRequest input = request.input;
  input.reading.with_unlabelled = true;
  report.input = ReadInput(input, read_before, warnings);
  const Recording& recording = report.input.recording;
  const WarningContext context(warnings, recording.file, recording.motion());
  ConverterConfig& config = report.config;
  config = ChosenConverter(request.converter, read_before, warnings).config;
  if (request.ignores_subject) config.subject_file.clear();
  CheckKeepsRecording(request.output, recording);
  LabelHints hints = request.hints;
  hints.taken = NamesThatStay(request.output, recording);
  MatchModel(request.input, &report.input, &config);
  if (report.input.reference->is_root_fixed()) {
    CheckIsNoOsim(report.input, "finding names of points");
  }
  report.found = FindLabels(request.input, hints, report.input, config, progress, warnings);
  return report;
}

LabelReport RunLabelling(const LabelRequest& request,
                         const std::function<bool(int, int)>& progress) {
  if (!request.output.empty()) CheckLabelledOutput(request.output, request.hints.has_others());
  ReadBefore read_before;
  read_before.choice = ChooseOnce(request.converter);
  OutputPlan outputs;
  NameInputs(request.input, &outputs);
  NameInputs(*read_before.choice.value, &outputs);
  for (const std::string& file : FilesOf(request.hints)) outputs.Read(file);
  outputs.Rewrite(request.output, request.input.file);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  outputs.Check();
  LabelReport report = LabelPoints(request, read_before, progress);
  outputs.Check();
  const Recording& recording = report.input.recording;
  const FoundLabels& found = report.found;
  const bool is_calibrated = found.person.subject != nullptr;
  const bool has_size = is_calibrated || report.input.reference->coordinates();
  const FittedLabels fitted =
      FitLabels(found, recording.markers, has_size ? nullptr : found.reference.get());
  report.fit = fitted.figures;
  Input written = report.input;
  written.recording.markers = Relabelled(PointsOfPerson(found), recording.markers);
  const auto names =
      UnderstoodNames(LabelsOf(written.recording.markers, recording.file), written, report.config);
  const NamingFigures naming = MeasureNaming(found.labelling, recording.markers);
  LabelEvidence evidence{recording,  naming, report.fit, is_calibrated, found.person.height.value,
                         names.get()};
  // Sides and places of a model of OpenSim, which has a size, are not judged.
  if (!report.input.reference->coordinates() && found.reference &&
      !fitted.setup.assignments().empty()) {
    const Questions asked = AskAboutLabels(evidence);
    if (asked.places) {
      evidence.labels.places = MeasurePlaces(fitted.setup, fitted.frames, fitted.trajectory);
    }
    if (asked.sides) {
      evidence.labels.sides = FindExchangedSides(
          fitted.setup, found.reference, ScalingOf(found.person, report.config), fitted.frames);
    }
  }
  report.verdict = JudgeLabels(evidence);
  return report;
}

std::vector<RelabelledPoint> PointsOfPerson(const FoundLabels& found) {
  std::set<std::string> others;
  for (const OtherBody& other : found.others) {
    for (int i = other.first_name; i < other.end_name; ++i) others.insert(found.labelling.names[i]);
  }
  std::vector<RelabelledPoint> points;
  for (const RelabelledPoint& point : found.points) {
    if (point.label.starts_with('*')) continue;
    if (point.is_named && others.contains(point.label)) continue;
    points.push_back(point);
    if (point.is_named) points.back().label.erase(0, found.prefix.size());
  }
  return points;
}

std::set<std::string> NamesThatFit(const FoundLabels& found, const MarkerSequence& markers,
                                   double most) {
  const NamedMarkersOf of = FindMarkers(found, markers);
  std::set<std::string> names;
  if (of.markers.size() < kFewestPoints) return names;
  const Eigen::MatrixXd distances = Distances(found, of, markers, nullptr);
  for (Eigen::Index m = 0; m < distances.cols(); ++m) {
    if (MeanDistance(distances, m) <= most) names.insert(of.names[static_cast<std::size_t>(m)]);
  }
  return names;
}

NamingFigures MeasureNaming(const Labelling& labelling, const MarkerSequence& markers) {
  NamingFigures figures;
  std::vector<int> unnamed(static_cast<std::size_t>(markers.num_labels()), 0);  // frames, by point
  double unsure = 0, named = 0;
  for (const NamedPiece& piece : labelling.pieces) {
    const int length = piece.end - piece.begin;
    if (piece.name < 0) {
      unnamed[piece.point] += length;
    } else {
      named += length;
      unsure += (1 - piece.probability) * length;
    }
  }
  figures.num_names = static_cast<int>(labelling.names.size());
  figures.missing = NamesNotFound(labelling);
  figures.spare_points = static_cast<int>(std::count_if(
      unnamed.begin(), unnamed.end(), [&](int n) { return 2 * n > markers.num_frames(); }));
  if (named > 0) figures.unsure = unsure / named;
  return figures;
}

FittedLabels FitLabels(const FoundLabels& found, const MarkerSequence& markers,
                       const KinematicModel* reference) {
  FittedLabels fitted;
  LabelFit& fit = fitted.figures;
  const MarkerSequence named = Relabelled(PointsOfPerson(found), markers);
  const NamedMarkersOf of = FindMarkers(found, named);
  if (of.markers.size() < kFewestPoints) return fitted;
  const Eigen::MatrixXd distances = Distances(found, of, named, &fitted);
  if (!distances.array().isFinite().any()) return fitted;
  fitted.setup = found.setup;
  fitted.setup.mapping.assignments.clear();
  for (std::size_t m = 0; m < of.markers.size(); ++m) {
    const double scale = of.noise_scale[static_cast<Eigen::Index>(m)];
    fitted.setup.mapping.assignments.push_back({of.columns[m], of.markers[m], scale});
  }
  for (Eigen::Index m = 0; m < distances.cols(); ++m) {
    const double mean = MeanDistance(distances, m);
    if (!std::isfinite(mean)) continue;
    fit.farthest = std::max(fit.farthest, mean);
    if (kMarkerMean.IsBeyond(mean)) fit.far_names.push_back(of.names[static_cast<std::size_t>(m)]);
  }
  const std::span<const double> all(distances.data(), static_cast<std::size_t>(distances.size()));
  fit.mean_distance = Mean(all);
  fit.p95_distance = Percentile(all, 95);
  if (reference == nullptr) return fitted;
  // In a repair the names that were there tell the height: those that were found were sought at it.
  const bool are_old_right = found.is_repair && !found.has_exchanged_sides;
  const MarkerSequence& telling = are_old_right ? markers : named;
  const NamedMarkersOf told = FindMarkers(found, telling);
  if (told.markers.size() < kFewestPoints) return fitted;
  HeightOptions options;
  options.noise_scale = told.noise_scale;
  fit.told_height =
      EstimateHeight(*reference, found.setup.joints, told.markers, told.columns, telling, options)
          .height;
  return fitted;
}

}  // namespace mmm_converter
