// SPDX-License-Identifier: MIT
#include "common/pipeline/marker_learning.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "common/convert/converter_config.h"
#include "common/convert/marker_set_text.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/support/error.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

Person FindWearer(const LearnRequest& request, const Input& input, const ConverterConfig& config,
                  Warnings* warnings) {
  const PersonRequest& person = request.inputs.front().person;
  if (config.model_processor == "None") throw Error(WhyUnscaled(config));
  const Recording& recording = input.recording;
  const bool is_told =
      person.size.height || !person.processor_file.empty() || recording.size().height;
  if (is_told) {
    return FindPersonOfPoints(person, *input.reference, recording, config, warnings);
  }
  // Labels that are understood tell it, as they do where the recording is converted.
  try {
    Warnings of_labels;
    const MatchedLabels matched =
        MatchLabels(LabelsOf(recording.markers, recording.file), input, config, &of_labels);
    return FindPerson(person, matched.setup, recording, config, warnings, matched.names.get());
  } catch (const Error&) {
    throw Error(
        "how tall is the person? Markers whose places are not known yet do not tell; give the "
        "height",
        Remedy::kHeight);
  }
}

void CheckHasMarkers(const LearnedMarkers& learned) {
  std::vector<std::string> left_out;
  for (const LearnedMarker& marker : learned.markers) {
    if (marker.left_out.empty()) return;
    left_out.push_back(fmt::format("{}: {}", marker.label, marker.left_out));
  }
  throw Error(fmt::format(
      "it is not sure of any of {} labels where they are worn ({}); a recording of one person in "
      "which all joints move tells more, and so do usual names",
      left_out.size(), FirstNames(left_out, 3)));
}

std::string Describe(const LearnedMarker& marker) {
  return fmt::format("{:.0f} % sure, moves by {:.0f} mm", 100 * marker.probability,
                     kMillimetres * marker.scatter);
}

}  // namespace

LearnReport RunLearning(const LearnRequest& request,
                        const std::function<void(int, int)>& progress) {
  LearnReport report;
  report.output = request.output;
  report.name =
      request.name.empty() ? std::filesystem::path(request.output).stem().string() : request.name;
  Warnings* const warnings = &report.warnings;
  ConverterChoice choice = ChooseConverter(request.converter, warnings);
  OutputPlan outputs;
  for (const InputRequest& input : request.inputs) NameInputs(input, &outputs);
  NameInputs(choice, &outputs);
  outputs.Write(request.output);
  for (const std::string& file : request.more_outputs) outputs.Write(file);
  outputs.Check();
  // Labels that no marker set knows are what this is for.
  choice.config.marker_set = "auto";
  choice.config.subject_file.clear();
  std::vector<const MarkerSequence*> recordings;
  for (const InputRequest& input : request.inputs) {
    report.inputs.push_back(ReadInput(input, {}, warnings));
  }
  for (const Input& input : report.inputs) recordings.push_back(&input.recording.markers);
  MatchModel(request.inputs.front(), &report.inputs.front(), &choice.config);
  outputs.Check();
  const Input& first = report.inputs.front();
  report.person = FindWearer(request, first, choice.config, warnings);
  const PersonScaling scaling = ScalingOf(report.person, choice.config);
  const auto scale = [&](const KinematicModel& model) { return ScaleModel(model, scaling); };
  report.learned =
      LearnMarkers({*first.reference, scale, ResolveJoints(choice.config, *first.reference)},
                   recordings, progress);
  for (const std::string& warning : report.learned.warnings) warnings->Add(warning);
  CheckHasMarkers(report.learned);
  return report;
}

std::string FormatLearnedSet(const LearnReport& report) {
  MarkerSet set;
  set.name = report.name;
  std::vector<std::string> remarks, tail;
  for (const LearnedMarker& marker : report.learned.markers) {
    if (!marker.left_out.empty()) {
      tail.push_back(fmt::format("{}: left out, {}", marker.label, marker.left_out));
      continue;
    }
    set.places.push_back(
        {marker.label, marker.segment, marker.p_SM / report.person.height.value, 0});
    remarks.push_back(Describe(marker));
  }
  set.description = fmt::format("learnt, {} markers of {} labels", set.places.size(),
                                report.learned.markers.size());
  std::string files;
  for (const Input& input : report.inputs) {
    const std::string name = std::filesystem::path(input.recording.file).filename().string();
    files += (files.empty() ? "" : ", ") + name;
  }
  const std::string head = fmt::format(
      "Learnt by MMMConverterS2KF from {}, of a person of {:g} m. Places are in mm of the model of "
      "1 m, in axes of the segment. Look at what is left out, at the end.",
      files, report.person.height.value);
  return FormatMarkerSet(set, head, remarks, tail);
}

}  // namespace mmm_converter
