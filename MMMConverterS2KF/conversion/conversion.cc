// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/conversion/conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "MMMConverterS2KF/conversion/motion_output.h"
#include "common/io/mmm/mmm_model_subject.h"
#include "common/io/mmm/subject_file.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

void TakeConverter(const ConversionRequest& request, ConversionReport* report) {
  if (request.choice.value) {
    report->converter = *request.choice.value;
    report->warnings.Append(request.choice.warnings);
  } else {
    report->converter = ChooseConverter(request.converter, &report->warnings);
  }
}

// The person as the recording itself shows them.
void SelfCalibrate(const ConverterConfig& config, ConversionReport* report) {
  if (config.model_processor == "None") {
    throw Error(WhyUnscaled(config) + ", but a subject is relative to the scaled one");
  }
  const Recording& recording = report->input.recording;
  const std::string file = std::filesystem::path(recording.file).filename().string();
  const KinematicModel& scaled = *report->model;
  report->calibration =
      CalibratePerson(scaled, ResolveJoints(config, scaled),
                      {{file, &recording.markers, report->mapping.assignments}}, report->person,
                      SubjectName(report->input), &report->warnings);
  report->person.subject = std::make_shared<Subject>(report->calibration->subject);
  report->model =
      std::make_shared<KinematicModel>(FitToSubject(scaled, report->calibration->subject));
}

// Models that are built go into the folder given, else into one beside the output.
std::string FolderOfNewModels(const ConversionRequest& request, const ConversionReport& report) {
  std::error_code failure;
  if (!request.object_models.empty()) return request.object_models;
  if (!request.builds_models || std::filesystem::is_other(report.output, failure)) return "";
  return std::filesystem::path(report.output).replace_extension().string() + "_objects";
}

void TakeObject(const ConversionRequest& request, ConversionReport* report) {
  ObjectRequest object;
  object.is_object = request.is_object;
  object.is_person =
      !request.is_one_of_all && (IsGiven(request.input.person) || request.self_calibrate);
  object.name = report->motion_name;
  object.models = request.object_models;
  object.new_models = FolderOfNewModels(request, *report);
  object.has_model_given = !request.input.model_file.empty() && !request.is_one_of_all;
  report->object = TakeObject(object, &report->input, &report->converter.config, &report->warnings);
}

// Configurations know how far markers stray from a model of a person. On an object nothing moves
// under them: with a tenth of that, KIT's recordings of objects have innovations of the size that
// the filter expects (NIS over its degrees of freedom 0.2 to 1.3; with all of it, 0.01).
void TrustMarkersOfObject(MarkerMapping* mapping) {
  constexpr double kNoiseOfObjects = 0.1;
  for (MarkerAssignment& assignment : mapping->assignments) {
    assignment.noise_scale *= kNoiseOfObjects;
  }
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

void CheckHasSubject(const ConversionRequest& request, const ConversionReport& report) {
  if (report.person.subject) return;
  if (!request.subject_output.empty()) {
    throw Error("--subject-out " + request.subject_output + ": a rigid object is no subject");
  }
  if (!request.model_output.empty()) {
    throw Error(
        fmt::format("--model-out {}: no subject is known whose model that would be; use "
                    "--self-calibrate or --subject-file",
                    request.model_output));
  }
}

}  // namespace

void CheckOutputs(const ConversionRequest& request,
                  const std::vector<const ConversionReport*>& reports) {
  OutputPlan plan;
  NameInputs(request.input, &plan);
  for (const ConversionReport* report : reports) {
    NameInputs(report->converter, &plan);
    plan.Read(report->person.subject_file);
    if (report->object && report->object->is_built()) {
      plan.WriteIntoFolder(report->input.model_file);
    } else {
      plan.Read(report->input.model_file);
    }
  }
  plan.Rewrite(reports.front()->output, request.input.file);
  plan.Write(request.subject_output);
  plan.Write(request.model_output);
  for (const auto& [unused, file] : request.exports) plan.Write(file);
  for (const std::string& file : request.more_outputs) plan.Write(file);
  plan.Check();
}

ConversionReport RunConversion(const ConversionRequest& request,
                               const std::function<bool(int, int)>& progress) {
  ConversionReport report;
  Warnings& warnings = report.warnings;
  report.input = ReadInput(request.input, &warnings);
  TakeConverter(request, &report);
  const WarningContext context(&warnings, request.input.file, report.input.recording.motion);
  ConverterConfig& config = report.converter.config;
  MatchModel(request.input, &report.input, &config);
  if (request.self_calibrate) config.subject_file.clear();
  report.output_format =
      request.output_format.empty() ? config.output_format : request.output_format;
  report.output = ChooseOutput(request, report);
  report.motion_name = ChooseMotionName(request, report.input.recording);

  TakeObject(request, &report);
  const KinematicModel& reference = *report.input.reference;
  const MarkerSequence& markers = report.input.recording.markers;
  const std::vector<MarkerPair> pairs =
      ResolveMarkerPairs(config, markers, reference, &report.marker_set);
  report.mapping = ResolveMarkerMapping(pairs, markers, reference, &warnings);
  const std::vector<MarkerAssignment>& assignments = report.mapping.assignments;
  CheckDeterminesPose(report.input, report.mapping);
  if (report.object) TrustMarkersOfObject(&report.mapping);
  const PersonRequest person = report.object ? PersonRequest() : request.input.person;
  report.model = std::make_shared<KinematicModel>(ScaleToPerson(
      person, reference, report.input.recording, config, assignments, &report.person, &warnings));

  if (request.self_calibrate && !report.object) SelfCalibrate(config, &report);
  CheckHasSubject(request, report);
  if (!request.is_one_of_all) CheckOutputs(request, {&report});
  report.subject_output = request.subject_output;
  report.model_output = request.model_output;

  const auto converter =
      report.converter.plugin->factory().Create(*report.model, assignments, config);
  report.result = converter->Convert(markers, *report.model, assignments, [&](int done) {
    return !progress || progress(done, markers.num_frames());
  });
  if (report.object) {
    JudgeObject(report.input, report.mapping, report.result.residuals, &warnings);
  }
  return report;
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
