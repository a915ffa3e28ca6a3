// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/pipeline.h"

#include <fmt/format.h>

#include <filesystem>

#include "MMMConverterS2KF/motion_output.h"
#include "MMMConverterS2KF/output_files.h"
#include "common/io/mmm_model_subject.h"
#include "common/io/subject_file.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

void AddWarnings(const std::vector<std::string>& more, ConversionReport* report) {
  report->warnings.insert(report->warnings.end(), more.begin(), more.end());
}

// The person as the recording itself shows them.
void SelfCalibrate(const ConverterConfig& config, ConversionReport* report) {
  if (config.model_processor == "None") {
    throw Error(WhyUnscaled(config) + ", but a subject is relative to the scaled one");
  }
  const Recording& recording = report->input.recording;
  const std::string file = std::filesystem::path(recording.file).filename().string();
  const KinematicModel& scaled = *report->model;
  report->calibration = CalibratePerson(scaled, ResolveJoints(config, scaled),
                                        {{file, &recording.markers, report->mapping.assignments}},
                                        report->person, SubjectName(report->input));
  AddWarnings(report->calibration->warnings, report);
  report->person.subject = std::make_shared<Subject>(report->calibration->subject);
  report->model =
      std::make_shared<KinematicModel>(FitToSubject(scaled, report->calibration->subject));
}

void CheckOutputs(const ConversionRequest& request, const ConversionReport& report) {
  if (!request.model_output.empty() && !report.person.subject) {
    throw Error(
        fmt::format("--model-out {}: no subject is known whose model that would be; use "
                    "--self-calibrate or --subject-file",
                    request.model_output));
  }
  const std::vector<std::string> inputs = {
      request.input.file, report.input.model_file, request.input.person.processor_file,
      report.person.subject_file, report.converter.config.file};
  std::vector<std::string> outputs = {request.subject_output, request.model_output,
                                      request.exports.csv, request.exports.trc,
                                      request.exports.mot};
  outputs.insert(outputs.end(), request.more_outputs.begin(), request.more_outputs.end());
  for (const std::string& output : outputs) CheckIsNoInput(output, inputs);
  outputs.push_back(report.output);
  CheckAreDifferentFiles(outputs);
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

}  // namespace

ConversionReport RunConversion(const ConversionRequest& request,
                               const std::function<bool(int, int)>& progress) {
  ConversionReport report;
  report.input = ReadInput(request.input);
  AddWarnings(report.input.warnings, &report);
  report.converter = request.choice ? *request.choice : ChooseConverter(request.converter);
  AddWarnings(report.converter.config.warnings, &report);
  ConverterConfig& config = report.converter.config;
  MatchModel(request.input, &report.input, &config);
  if (request.self_calibrate) config.subject_file.clear();
  report.output_format =
      request.output_format.empty() ? config.output_format : request.output_format;
  report.output = ChooseOutput(request, report);
  report.motion_name = ChooseMotionName(request, report.input.recording);

  const KinematicModel& reference = *report.input.reference;
  const MarkerSequence& markers = report.input.recording.markers;
  const std::vector<MarkerPair> pairs =
      ResolveMarkerPairs(config, markers, reference, &report.marker_set);
  report.mapping = ResolveMarkerMapping(pairs, markers, reference);
  AddWarnings(report.mapping.warnings, &report);
  const std::vector<MarkerAssignment>& assignments = report.mapping.assignments;
  report.model = std::make_shared<KinematicModel>(
      ScaleToPerson(request.input.person, reference, report.input.recording, config, assignments,
                    &report.person, &report.warnings));

  if (request.self_calibrate) SelfCalibrate(config, &report);
  CheckOutputs(request, report);
  report.subject_output = request.subject_output;
  report.model_output = request.model_output;

  const auto converter =
      report.converter.plugin->factory().Create(*report.model, assignments, config);
  report.result = converter->Convert(markers, *report.model, assignments, [&](int done) {
    return !progress || progress(done, markers.num_frames());
  });
  return report;
}

void WriteConversion(const ConversionRequest& request, ConversionReport* report) {
  WriteMotion(request, report);
  WritePerson(*report);
  WriteExports(request.exports, *report);
}

}  // namespace mmm_converter
