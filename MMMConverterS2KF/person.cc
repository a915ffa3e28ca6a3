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

PersonValue Estimate(const KinematicModel& reference, const Recording& recording,
                     const ConverterConfig& config,
                     const std::vector<MarkerAssignment>& assignments) {
  std::vector<int> markers;
  std::vector<int> labels;
  for (const MarkerAssignment& assignment : assignments) {
    markers.push_back(assignment.marker);
    labels.push_back(assignment.label);
  }
  const HeightEstimate estimate = EstimateHeight(reference, ResolveJoints(config, reference),
                                                 markers, labels, recording.markers);
  return {estimate.height, fmt::format("estimated from {} frames", estimate.frames)};
}

}  // namespace

KinematicModel ScaleToPerson(const PersonRequest& request, const KinematicModel& reference,
                             const Recording& recording, const ConverterConfig& config,
                             const std::vector<MarkerAssignment>& assignments, Person* person,
                             std::vector<std::string>* warnings) {
  if (config.model_processor == "None") {
    if (request.height || request.mass || request.hand_length || !request.processor_file.empty()) {
      warnings->push_back(config.file +
                          ": <Model name=\"None\">: the model is not scaled; height, mass and "
                          "hand length are left out");
    }
    person->height = {0, "model is not scaled"};
    person->mass = person->height;
    return reference;
  }
  ProcessorConfig file;
  if (!request.processor_file.empty()) file = ReadProcessorConfig(request.processor_file);
  const auto height = Choose(request.height, file.height, request.processor_file, recording.height);
  const auto mass = Choose(request.mass, file.mass, request.processor_file, recording.mass);
  const auto hand_length =
      Choose(request.hand_length, file.hand_length, request.processor_file, recording.hand_length);
  person->height = height ? *height : Estimate(reference, recording, config, assignments);
  person->mass = mass ? *mass : PersonValue{kAssumedMass, "assumed"};
  if (hand_length) person->hand_length = hand_length->value;
  return ScaleWinter(reference, {person->height.value, person->mass.value, person->hand_length});
}

}  // namespace mmm_converter
