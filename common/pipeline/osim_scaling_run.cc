// SPDX-License-Identifier: MIT
#include "common/pipeline/osim_scaling_run.h"

#include <fmt/format.h>

#include "common/io/bytes/file_content.h"
#include "common/io/osim/osim_model_reader.h"
#include "common/io/osim/osim_xml.h"
#include "common/io/osim/tool_setup.h"
#include "common/support/error.h"

namespace mmm_converter {

void NameInputs(const OsimScalingRequest& request, OutputPlan* plan) {
  NameInputs(request.input, plan);
  plan->Read(request.setup_file);
}

OsimScalingReport RunOsimScaling(const OsimScalingRequest& request) {
  OsimScalingReport report;
  const Input input = ReadInput(request.input, {}, &report.warnings);
  if (!input.model->model.coordinates()) {
    throw Error(fmt::format("{}: is no model of OpenSim, which the set-up {} is for",
                            input.model_file, request.setup_file));
  }
  const auto beside = [&](const std::string& name) {
    return FindFileOfSetup(request.setup_file, name, "part", &report.warnings);
  };
  const ScaleSetup setup = ParseScaleSetup(
      ReadFileContent(request.setup_file, kMaxOsimBytes), request.setup_file,
      [&](const std::string& name) { return ReadFileContent(beside(name), kMaxOsimBytes); });
  std::vector<std::string> files;
  if (!setup.marker_file.empty()) files.push_back(beside(setup.marker_file));
  if (!request.input.marker_file.empty()) files.push_back(request.input.marker_file);
  std::vector<std::string> contents;
  std::vector<NamedText> markers;
  contents.reserve(files.size());
  for (const std::string& file : files) {
    contents.push_back(ReadFileContent(file, kMaxOsimBytes));
    markers.push_back({contents.back(), file});
  }
  const std::string model = ReadFileContent(input.model_file, kMaxOsimBytes);
  const MarkerSequence& recording = input.recording.markers;
  report.frames = recording.num_frames();
  report.scaled = ScaleOsimPerson({model, input.model_file}, markers, setup, request.setup_file,
                                  recording, &report.warnings);
  return report;
}

OsimScalingReport RunOsimCalibration(const CalibrationRequest& request,
                                     WithWarnings<ConverterConfig> configuration,
                                     const std::function<void(int, int)>& progress) {
  OsimScalingReport report;
  report.warnings = std::move(configuration.warnings);
  ConverterConfig& config = configuration.value;
  std::vector<CalibrationInput> inputs =
      ReadCalibrationInputs(request, &config, progress, &report.warnings);
  const InputRequest& first = request.inputs.front();
  const BodySize& size = first.person.size;
  if (size.height || size.hand_length) {
    report.warnings.Add("height and hand length change nothing: a model of OpenSim has a size");
  }
  const std::string file = ModelFile(first);
  const std::string model = ReadFileContent(file, kMaxOsimBytes);
  Diagnostics diagnostics(file);
  const OsimDocument document = ParseOsimDocument(model, first.marker_file, &diagnostics, nullptr);
  CheckIsSmallEnough(file, static_cast<int>(document.bodies.size()) - 1, "bodies");
  const TrackingSetup& setup = inputs.front().setup;
  CalibrationOptions options = OsimCalibrationOptions();
  const auto all = static_cast<int>(inputs.size());
  if (progress) options.between_steps = [&progress, all] { progress(all, all); };
  Warnings warnings;
  const OsimPersonFacts person = {
      request.name.empty() ? SubjectName(inputs.front().input) : request.name, size.mass,
      size.height, SubjectProgram()};
  CalibratedOsim calibrated = CalibrateOsim({model, file}, document, *setup.model, setup.joints,
                                            RecordingsOf(inputs), person, options, &warnings);
  report.warnings.AppendNew(warnings);
  CheckProportions(calibrated.result.subject);
  report.verdict = MeasureAndJudge(calibrated.result, inputs, {});
  report.scaled = std::move(calibrated.scaled);
  report.frames = calibrated.result.frames;
  report.result = std::move(calibrated.result);
  report.size = calibrated.size;
  report.model = std::move(calibrated.model);
  report.recordings = std::move(inputs);
  return report;
}

bool IsOsimModel(const InputRequest& request) {
  constexpr std::size_t kHeadBytes = 1 << 16;
  return IsOsimDocument(ReadFileStart(ModelFile(request), kHeadBytes));
}

}  // namespace mmm_converter
