// SPDX-License-Identifier: MIT
#include "common/pipeline/osim_scaling_run.h"

#include <fmt/format.h>

#include <filesystem>

#include "common/io/bytes/file_content.h"
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
  const auto beside = [&request](const std::string& name) {
    return (std::filesystem::path(request.setup_file).parent_path() / name).string();
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

}  // namespace mmm_converter
