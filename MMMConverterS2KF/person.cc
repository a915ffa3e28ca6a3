// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/person.h"

#include <fmt/format.h>

#include "common/convert/converter_config.h"
#include "common/fit/height_estimate.h"
#include "common/io/processor_config.h"
#include "common/model/model_scaling.h"

namespace mmm_converter {
namespace {

constexpr double kAssumedMass = 70;  // [kg]

// The first source that has a value.
std::optional<PersonValue> Choose(const std::optional<double>& given,
                                  const std::optional<double>& in_processor_file,
                                  const std::string& processor_file,
                                  const std::optional<double>& in_recording) {
  if (given) return PersonValue{*given, "given"};
  if (in_processor_file) return PersonValue{*in_processor_file, processor_file};
  if (in_recording) return PersonValue{*in_recording, "from the recording's file"};
  return std::nullopt;
}

PersonValue Estimate(const KinematicModel& reference, const ConversionReport& report) {
  std::vector<int> markers;
  std::vector<int> labels;
  for (const MarkerAssignment& assignment : report.mapping.assignments) {
    markers.push_back(assignment.marker);
    labels.push_back(assignment.label);
  }
  const HeightEstimate estimate = EstimateHeight(reference, ResolveJoints(report.config, reference),
                                                 markers, labels, report.recording.markers);
  return {estimate.height, fmt::format("estimated from {} frames", estimate.frames)};
}

}  // namespace

KinematicModel ScaleToPerson(const ConversionRequest& request, const KinematicModel& reference,
                             ConversionReport* report) {
  if (report->config.model_processor == "None") {
    if (request.height || request.mass || request.hand_length || !request.processor_file.empty()) {
      report->warnings.push_back(
          report->config.file +
          ": <Model name=\"None\">: the model is not scaled; height, mass and "
          "hand length are left out");
    }
    report->height = {0, "model is not scaled"};
    report->mass = report->height;
    return reference;
  }
  ProcessorConfig file;
  if (!request.processor_file.empty()) file = ReadProcessorConfig(request.processor_file);
  const Recording& recording = report->recording;
  const auto height = Choose(request.height, file.height, request.processor_file, recording.height);
  const auto mass = Choose(request.mass, file.mass, request.processor_file, recording.mass);
  const auto hand_length =
      Choose(request.hand_length, file.hand_length, request.processor_file, recording.hand_length);
  report->height = height ? *height : Estimate(reference, *report);
  report->mass = mass ? *mass : PersonValue{kAssumedMass, "assumed"};
  if (hand_length) report->hand_length = hand_length->value;
  return ScaleWinter(reference, {report->height.value, report->mass.value, report->hand_length});
}

}  // namespace mmm_converter
