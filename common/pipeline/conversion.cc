// SPDX-License-Identifier: MIT
#include "common/pipeline/conversion.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/io/mmm/mmm_model_subject.h"
#include "common/io/mmm/subject_file.h"
#include "common/pipeline/motion_output.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "common/support/output_plan.h"

namespace mmm_converter {
namespace {

// The person as the recording itself shows them. No frame is done meanwhile.
void SelfCalibrate(const std::function<bool(int, int)>& progress, ConversionReport* report) {
  const Recording& recording = report->input.recording;
  const std::string file = std::filesystem::path(recording.file).filename().string();
  TrackingSetup& setup = report->setup;
  report->calibration =
      CalibratePerson(*setup.model, setup.joints, {{file, &recording.markers, setup.assignments()}},
                      report->person, SubjectName(report->input), &report->warnings, [&] {
                        if (progress && !progress(0, recording.markers.num_frames())) {
                          throw Error(file + ": cancelled");
                        }
                      });
  report->person.subject = std::make_shared<Subject>(report->calibration->subject);
  setup.model =
      std::make_shared<KinematicModel>(FitToSubject(*setup.model, report->calibration->subject));
}

void CheckHasSubject(const ConversionRequest& request, const ConversionPlan& plan) {
  const bool is_calibrated = request.self_calibrate && !plan.object;
  if (is_calibrated && plan.converter.config.model_processor == "None") {
    throw Error(WhyUnscaled(plan.converter.config) +
                ", but a subject is relative to the scaled one");
  }
  if (is_calibrated || plan.person.subject) return;
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

// Of one of several motions of a file the request's person and model are those of its persons.
ObjectRequest ObjectRequestOf(const ConversionRequest& request, const ConversionPlan& plan,
                              bool is_one_of_several) {
  std::error_code failure;
  ObjectRequest object;
  object.is_object = request.is_object;
  object.is_person =
      !is_one_of_several && (IsGiven(request.input.person) || request.self_calibrate);
  object.name = plan.motion_name;
  object.models = request.object_models;
  object.new_models = request.object_models;
  if (object.new_models.empty() && !std::filesystem::is_other(plan.output, failure)) {
    object.new_models =
        std::filesystem::path(plan.output).replace_extension().string() + "_objects";
  }
  object.has_model_given = !is_one_of_several && !request.input.model_file.empty();
  return object;
}

// The input's points under the names that are found for them; the others are left out.
void LabelInput(const ConversionRequest& request, const ConverterConfig& config,
                const std::function<bool(int, int)>& progress, ConversionPlan* plan) {
  MarkerSequence& markers = plan->input.recording.markers;
  plan->labels = FindLabels(request.input, request.label_hints, plan->input, config, progress,
                            &plan->warnings);
  markers = Relabelled(PointsOfPerson(*plan->labels), markers);
}

void WritePerson(const ConversionReport& report) {
  if (!report.subject_output.empty()) {
    WriteFileAtomically(report.subject_output,
                        FormatSubject(*report.person.subject, SubjectProgram()));
  }
  if (!report.model_output.empty()) {
    WriteFileAtomically(report.model_output,
                        ReadModelForSubject(report.input.model_file, *report.person.subject));
  }
}

// Errors name the file.
ConversionResult Track(const ConversionReport& report,
                       const std::function<bool(int, int)>& progress) {
  const Recording& recording = report.input.recording;
  const int frames = recording.markers.num_frames();
  const auto converter =
      report.converter.plugin->factory().Create(report.setup, report.converter.config);
  if (report.keeps_covariances && !converter->KeepCovariances()) {
    throw Error(fmt::format("{} tells no covariances; use S2KFConverter, or do without them",
                            report.converter.config.type));
  }
  try {
    return converter->Convert(recording.markers,
                              [&](int done) { return !progress || progress(done, frames); });
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", recording.file, error.what()), error.remedy());
  }
}

}  // namespace

ConversionPlan PlanConversion(const ConversionRequest& request, const ReadBefore& read_before,
                              const std::function<bool(int, int)>& progress) {
  ConversionPlan plan;
  Warnings* warnings = &plan.warnings;
  InputRequest input = request.input;
  input.reading.with_unlabelled = request.label;
  plan.input = ReadInput(input, read_before, warnings);
  const Recording& recording = plan.input.recording;
  const WarningContext context(warnings, recording.file, recording.motion());
  plan.converter = TakeConverter(request.converter, read_before, warnings);
  ConverterConfig& config = plan.converter.config;
  MatchModel(request.input, &plan.input, &config);
  if (request.self_calibrate) config.subject_file.clear();
  if (request.label) LabelInput(request, config, progress, &plan);
  const bool is_one_of_several = read_before.motion.value != nullptr;
  ChooseMotionOutput(request, is_one_of_several, &plan);
  plan.object =
      FindObject(ObjectRequestOf(request, plan, is_one_of_several), plan.input, config, warnings);
  if (plan.object) {
    UseModel(*plan.object, &plan.input);
    config = ConfigOfObject(plan.input, config);
  }

  plan.setup = MatchMarkers(LabelsOf(recording.markers, recording.file), plan.input.reference,
                            config, warnings);
  WarnOfFreeJoints(plan.setup, config, warnings);
  CheckDeterminesPose(plan.input, plan.setup.mapping);
  if (plan.object) TrustMarkersOfObject(&plan.setup.mapping);
  const PersonRequest person = plan.object ? PersonRequest() : request.input.person;
  plan.person = FindPerson(person, plan.setup, recording, config, warnings);
  ScaleToPerson(ScalingOf(plan.person, config), &plan.setup);
  CheckHasSubject(request, plan);
  plan.subject_output = request.subject_output;
  plan.model_output = request.model_output;
  plan.keeps_covariances = request.keeps_covariances || NeedCovariances(request.exports);
  return plan;
}

void CheckOutputs(const ConversionRequest& request,
                  const std::vector<const ConversionPlan*>& plans) {
  OutputPlan outputs;
  NameInputs(request.input, &outputs);
  if (request.label) {
    for (const std::string& file : FilesOf(request.label_hints)) outputs.Read(file);
  }
  for (const ConversionPlan* plan : plans) {
    NameInputs(plan->converter, &outputs);
    outputs.Read(plan->person.subject_file);
    if (plan->object && plan->object->is_built()) {
      outputs.WriteIntoFolder(plan->input.model_file);
    } else {
      outputs.Read(plan->input.model_file);
    }
  }
  outputs.Rewrite(plans.front()->output, request.input.file);
  outputs.Write(request.subject_output);
  outputs.Write(request.model_output);
  for (const auto& [unused, file] : request.exports) outputs.Write(file);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  outputs.Check();
}

ConversionReport CarryOut(ConversionPlan plan, bool self_calibrate,
                          const std::function<bool(int, int)>& progress) {
  ConversionReport report{std::move(plan), {}, {}, {}, {}};
  const WarningContext context(&report.warnings, report.input.recording.file,
                               report.input.recording.motion());
  if (self_calibrate && !report.object) SelfCalibrate(progress, &report);
  report.result = Track(report, progress);
  if (report.object) {
    WarnOfUnknownTurns(report.input, report.setup.mapping, report.result.residuals,
                       &report.warnings);
  }
  report.figures = MeasureConversion(report);
  report.verdict = JudgeConversion(report);
  return report;
}

ConversionReport RunConversion(const ConversionRequest& request,
                               const std::function<bool(int, int)>& progress) {
  ConversionPlan plan = PlanConversion(request, {}, progress);
  CheckOutputs(request, {&plan});
  return CarryOut(std::move(plan), request.self_calibrate, progress);
}

void WriteObjectModel(const ConversionReport& report) {
  if (!report.object || !report.object->is_built()) return;
  std::error_code failure;  // writing says what is wrong
  std::filesystem::create_directory(std::filesystem::path(report.input.model_file).parent_path(),
                                    failure);
  WriteFileAtomically(report.input.model_file, report.object->text);
}

void WriteConversion(const ConversionRequest& request, ConversionReport* report) {
  WriteObjectModel(*report);
  WriteMotions(request, {report});
  WritePerson(*report);
  WriteExports(request.exports, *report);
}

}  // namespace mmm_converter
