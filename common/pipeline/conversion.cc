// SPDX-License-Identifier: MIT
#include "common/pipeline/conversion.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/angles/normal_bands.h"
#include "common/calibrate/joint_doubts.h"
#include "common/io/bytes/file_content.h"
#include "common/io/mmm/mmm_model_subject.h"
#include "common/io/mmm/subject_file.h"
#include "common/io/tables/osim_tables.h"
#include "common/judge/conversion_verdict.h"
#include "common/pipeline/force_exports.h"
#include "common/pipeline/ground_study.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/pipeline/motion_output.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// The person as the recording itself shows them. No frame is done meanwhile.
void SelfCalibrate(const std::function<bool(int, int)>& progress, ConversionReport* report) {
  ConversionPlan& plan = report->plan;
  const Recording& recording = plan.input.recording;
  const std::string file = std::filesystem::path(recording.file).filename().string();
  TrackingSetup& setup = plan.setup;
  plan.calibration =
      CalibratePerson(*setup.model, setup.joints, {{file, &recording.markers, setup.assignments()}},
                      plan.person, SubjectName(plan.input), &report->warnings, [&] {
                        if (progress && !progress(0, recording.markers.num_frames())) {
                          throw Error(file + ": cancelled");
                        }
                      });
  plan.person.subject = std::make_shared<Subject>(plan.calibration->subject);
  setup.model = std::make_shared<KinematicModel>(
      ScaleModel(*plan.input.reference, ScalingOf(plan.person, plan.converter.config)));
}

void CheckHasSubject(const ConversionRequest& request, const ConversionPlan& plan) {
  const bool is_calibrated = request.self_calibrate && !plan.object;
  if (is_calibrated && plan.converter.config.model_processor == "None") {
    throw Error(WhyUnscaled(plan.converter.config) +
                ", but a subject is relative to the scaled one");
  }
  if (is_calibrated || (plan.person.subject && !plan.input.model->subject)) return;
  if (!request.subject_output.empty()) {
    throw Error(OptionText("subject-out") + " " + request.subject_output +
                ": a rigid object is no subject");
  }
  if (!request.model_output.empty()) {
    throw Error(fmt::format("{} {}: no subject is known whose model that would be; use {} or {}",
                            OptionText("model-out"), request.model_output,
                            OptionText("self-calibrate"), OptionText("subject-file")));
  }
}

// Where a file has several motions, the request's person and model are those of its persons.
ObjectRequest ObjectRequestOf(const ConversionRequest& request, const ConversionPlan& plan,
                              bool is_one_of_several) {
  std::error_code failure;
  ObjectRequest object;
  object.is_object = request.is_object;
  object.is_person =
      !is_one_of_several && (IsGiven(request.input.person) || request.self_calibrate);
  object.name = plan.motion_name;
  object.models = request.object_models;
  if (request.builds_models) object.new_models = request.object_models;
  if (request.builds_models && object.new_models.empty() &&
      !std::filesystem::is_other(plan.output, failure)) {
    object.new_models =
        std::filesystem::path(plan.output).replace_extension().string() + "_objects";
  }
  object.has_model_given = !is_one_of_several && !request.input.model_file.empty();
  return object;
}

void WritePerson(const ConversionPlan& plan) {
  if (!plan.subject_output.empty()) {
    WriteFileAtomically(plan.subject_output, FormatSubject(*plan.person.subject, SubjectProgram()));
  }
  if (!plan.model_output.empty()) {
    WriteFileAtomically(plan.model_output,
                        ReadModelForSubject(plan.input.model_file, *plan.person.subject));
  }
}

// What can't be tracked by the configuration names it; faults of the plugin name that.
std::unique_ptr<MotionConverter> MakeOwnConverter(const ConversionPlan& plan) {
  const ConverterChoice& choice = plan.converter;
  try {
    return choice.plugin->factory().Create(plan.setup, choice.config);
  } catch (const Error& error) {
    const std::string what = error.what();
    if (what.starts_with(choice.plugin->path()) || what.starts_with(choice.config.file)) throw;
    throw Error(fmt::format("{}: {} ({})", choice.config.file, what, plan.input.model_file),
                error.remedy());
  }
}

// Errors name the file.
ConversionResult Track(const ConversionPlan& plan, const std::function<bool(int, int)>& progress) {
  const Recording& recording = plan.input.recording;
  const int frames = recording.markers.num_frames();
  const auto converter = MakeOwnConverter(plan);
  const bool wants_covariances = plan.keeps_covariances || plan.takes_covariances;
  const bool has_covariances = wants_covariances && converter->KeepCovariances();
  if (plan.keeps_covariances && !has_covariances) {
    throw Error(fmt::format("{} estimates no covariances; use S2KFConverter, or do without them",
                            plan.converter.config.type));
  }
  try {
    return converter->Convert(recording.markers,
                              [&](int done) { return !progress || progress(done, frames); });
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", recording.file, error.what()), error.remedy());
  }
}

}  // namespace

const std::string& LabelOf(const ConversionPlan& plan, int assignment) {
  return plan.input.recording.markers.labels()[plan.setup.assignments()[assignment].label];
}

ReadBefore LabelFirst(const ConversionRequest& request, ReadBefore read_before,
                      const std::function<bool(int, int)>& progress) {
  if (!request.label) return read_before;
  const OpenedFiles opened;
  LabelRequest labels;
  labels.input = request.input;
  labels.converter = request.converter;
  labels.hints = request.label_hints;
  labels.ignores_subject = request.self_calibrate;
  LabelReport report = LabelPoints(labels, read_before, progress);
  auto named = std::make_shared<NamedRecording>(
      NamedRecording{std::move(report.input), std::move(report.found)});
  MarkerSequence& markers = named->input.recording.markers;
  markers = Relabelled(PointsOfPerson(named->labels), markers);
  read_before.named = {std::move(named), std::move(report.warnings)};
  read_before.opened.insert(opened.files().begin(), opened.files().end());
  return read_before;
}

void PlanBody(const ConversionRequest& request, const MarkerLabels& labels, ConversionPlan* plan) {
  const ConverterConfig& config = plan->converter.config;
  Warnings* warnings = &plan->warnings;
  plan->input.keeps_usual_places = request.self_calibrate ||
                                   !request.input.person.subject_file.empty() ||
                                   !config.subject_file.empty();
  plan->setup = MatchLabels(labels, &plan->input, config, warnings);
  TellPlaces(plan->input, &plan->setup);
  WarnOfFreeJoints(plan->setup, config, warnings);
  CheckDeterminesPose(plan->input, plan->setup.mapping);
  if (plan->object) TrustMarkersOfObject(&plan->setup.mapping);
  const PersonRequest person = plan->object ? PersonRequest() : request.input.person;
  plan->person = FindPerson(person, plan->setup, plan->input.recording, config, warnings,
                            plan->input.names.get());
  if (!plan->object) UseModelsSubject(plan->input, &plan->person, warnings);
  ScaleToPerson(ScalingOf(plan->person, config), &plan->setup);
}

ConversionPlan PlanConversion(const ConversionRequest& request, const ReadBefore& read_before) {
  const OpenedFiles opened;
  OpenedFiles::Note(read_before.opened);
  ConversionPlan plan;
  Warnings* warnings = &plan.warnings;
  const NamedRecording* named = read_before.named.value.get();
  if (named != nullptr) {
    plan.input = named->input;
    plan.labels = named->labels;
    warnings->Append(read_before.named.warnings);
  } else if (request.label) {
    throw Error(request.input.file + ": the points are to be named first (LabelFirst)");
  } else {
    plan.input = ReadInput(request.input, read_before, warnings);
  }
  const Recording& recording = plan.input.recording;
  const WarningContext context(warnings, recording.file, recording.motion());
  plan.converter = ChosenConverter(request.converter, read_before, named ? nullptr : warnings);
  ConverterConfig& config = plan.converter.config;
  MatchModel(request.input, &plan.input, &config);
  if (request.self_calibrate) config.subject_file.clear();
  const bool is_one_of_several = read_before.motion.value != nullptr;
  ChooseMotionOutput(request, is_one_of_several, &plan);
  plan.object =
      FindObject(ObjectRequestOf(request, plan, is_one_of_several), plan.input, config, warnings);
  if (plan.object) {
    CheckIsNoOsim(plan.input, "converting a rigid object");
    UseModel(*plan.object, &plan.input);
    config = ConfigOfObject(plan.input, config);
  }

  PlanBody(request, LabelsOf(recording.markers, recording.file), &plan);
  CheckHasSubject(request, plan);
  CheckExports(request.exports, *plan.setup.model);
  plan.subject_output = request.subject_output;
  plan.model_output = request.model_output;
  // A skeleton tells its lengths itself.
  plan.self_calibrates =
      request.self_calibrate && !plan.object && plan.input.recording.body.empty();
  ReadPlates(request.exports, &plan);
  if (plan.forces) plan.events = EventsOfFile(plan.input, request.input.events);
  plan.emg = EmgOf(plan.input, request.input.emg, &plan.warnings);
  plan.patient = request.input.patient;
  if (const std::string& file = plan.patient.normal_file; !file.empty()) {
    plan.normal = std::make_shared<const NormalBands>(
        ParseNormalBands(ReadFileContent(file, kMostNormalBytes), file));
    const std::vector<std::string> lacking = LackingAngles(*plan.normal);
    if (!lacking.empty()) {
      plan.warnings.Add(fmt::format("{}: has no bands of {}: without them there are no scores",
                                    file, JoinNames(lacking)));
    }
  }
  plan.keeps_covariances = request.keeps_covariances || NeedCovariances(request.exports);
  plan.takes_covariances = TakeCovariances(request.exports);
  plan.opened = opened.files();
  return plan;
}

void CheckOutputs(const ConversionRequest& request,
                  const std::vector<const ConversionPlan*>& plans) {
  OutputPlan outputs;
  NameInputs(request.input, &outputs);
  for (const ConversionPlan* plan : plans) {
    outputs.Read(plan->opened);
    const bool is_built = plan->object && plan->object->is_built();
    if (is_built) outputs.WriteIntoFolder(plan->input.model_file);
  }
  outputs.Rewrite(plans.front()->output, request.input.file);
  outputs.WriteBeside(DeviationsOutput(*plans.front()), kOsimDeviations);
  outputs.Write(request.subject_output);
  outputs.Write(request.model_output);
  NameOutputs(request.exports, &outputs);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  outputs.Check();
}

ConversionReport CarryOut(ConversionPlan plan, const std::function<bool(int, int)>& progress) {
  ConversionReport report;
  report.plan = std::move(plan);
  report.warnings = report.plan.warnings;
  const Recording& recording = report.plan.input.recording;
  const WarningContext context(&report.warnings, recording.file, recording.motion());
  if (report.plan.self_calibrates) SelfCalibrate(progress, &report);
  report.result = Track(report.plan, progress);
  if (report.plan.person.subject) WidenDeviations(*report.plan.person.subject, &report.result);
  if (report.plan.object) {
    WarnOfUnknownTurns(report.plan.input, report.plan.setup.mapping, report.result.residuals,
                       &report.warnings);
  }
  StudyPlates(&report);
  MeasureAndJudge(&report);
  return report;
}

void MeasureAndJudge(ConversionReport* report) {
  const ConversionPlan& plan = report->plan;
  const MarkerSequence& markers = plan.input.recording.markers;
  const PersonScaling scaling = ScalingOf(plan.person, plan.converter.config);
  const bool is_height_stated = plan.person.height.value > 0 && plan.person.height_deviation == 0;
  report->figures = MeasureConversion(report->result);
  ConversionEvidence evidence{plan.input.recording, plan.input.first_frame,
                              plan.setup.assignments(), report->result, report->figures};
  evidence.subject = scaling.subject.get();
  evidence.names = plan.input.names.get();
  if (scaling.size) evidence.height = scaling.size->height;
  if (is_height_stated) evidence.height_source = plan.person.height.source;
  if (plan.object) {
    evidence.object_model = plan.input.model_file;
    evidence.body = MeasureObject(plan.setup, markers);
  } else {
    evidence.body = MeasureBody(plan.setup, markers, report->result);
  }
  const Questions asked = AskAboutConversion(evidence);
  const PoseTrajectory& trajectory = report->result.trajectory;
  if (asked.places) evidence.labels.places = MeasurePlaces(plan.setup, markers, trajectory);
  if (asked.height) {
    evidence.told_height = TellHeight(plan.setup, *plan.input.reference, markers,
                                      asked.is_far ? nullptr : &trajectory.postures);
  }
  if (asked.sides) {
    evidence.labels.sides = FindExchangedSides(plan.setup, plan.input.reference, scaling, markers);
  }
  report->verdict = JudgeConversion(evidence);
  if (!report->ground) return;
  for (const std::string& doubt : report->ground->doubts) AddDoubt(doubt, &report->verdict);
}

ConversionReport RunConversion(const ConversionRequest& request, const ReadBefore& read_before,
                               const std::function<bool(int, int)>& progress) {
  ConversionPlan plan = PlanConversion(request, read_before);
  CheckOutputs(request, {&plan});
  ConversionReport report = CarryOut(std::move(plan), progress);
  StudyExports(request.exports, &report);
  return report;
}

void WriteObjectModel(const ConversionPlan& plan) {
  if (!plan.object || !plan.object->is_built()) return;
  std::error_code failure;  // writing says what is wrong
  std::filesystem::create_directory(std::filesystem::path(plan.input.model_file).parent_path(),
                                    failure);
  WriteFileAtomically(plan.input.model_file, plan.object->text);
}

void WriteConversion(const ConversionRequest& request, ConversionReport* report) {
  FilesTogether files;
  WriteObjectModel(report->plan);
  WriteMotions(request, {report});
  WritePerson(report->plan);
  WriteExports(request.exports, *report);
  files.Commit();
}

}  // namespace mmm_converter
