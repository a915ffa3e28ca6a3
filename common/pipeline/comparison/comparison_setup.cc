// SPDX-License-Identifier: MIT
#include "common/pipeline/comparison/comparison_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include "common/pipeline/input/finished_motion.h"
#include "common/pipeline/input/matched_labels.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

template <typename Named>
void NumberRepeatedNames(std::vector<Named>* items) {
  std::map<std::string, int> count;
  for (Named& item : *items) {
    const int number = ++count[item.name];
    if (number > 1) item.name += fmt::format(" ({})", number);
  }
}

void ScaleTrialsModel(const InputRequest& request, ConverterConfig config, Input* read,
                      Trial* trial, Warnings* warnings) {
  MatchModel(request, read, &config);
  const Input& input = *read;
  const Recording& recording = input.recording;
  TrackingSetup setup = MatchLabels(LabelsOf(recording.markers, recording.file), read, config,
                                    nullptr);  // each row says it
  WarnOfFreeJoints(setup, config, warnings);
  Person person = FindPerson(request.person, setup, recording, config, warnings, input.names.get());
  UseModelsSubject(input, &person, warnings);
  ScaleToPerson(ScalingOf(person, config), &setup);
  trial->model = setup.model;
  trial->subject = person.subject;
}

}  // namespace

Contender MakeContender(const std::string& config) {
  Contender contender;
  contender.name = config.empty() ? "s2kf_default" : fs::path(config).stem().string();
  try {
    ConverterChoice choice = ChooseConverter({config, "", ""}, nullptr);
    contender.config = std::move(choice.config);
    contender.configuration = std::move(choice.text);
    contender.plugin = std::move(choice.plugin);
  } catch (const Error& error) {
    contender.failure = WithAdvice(error);
  }
  return contender;
}

void NameInputs(const Contender& contender, OutputPlan* plan) {
  NameInputs(ConverterChoice{contender.config, "", contender.plugin}, plan);
}

Trial MakeTrial(InputRequest request, const std::string& truth_file, const ConverterConfig& config,
                Warnings* warnings) {
  Trial trial;
  trial.name = fs::path(request.file).filename().string();
  try {
    Warnings of_input;
    Input input = ReadInput(request, {}, &of_input);
    warnings->Append(of_input);
    const WarningContext context(warnings, request.file, input.recording.motion());
    if (!truth_file.empty()) {
      const MmmMotion truth = ReadPostures(truth_file, input.recording.motion());
      trial.truth = AlignFrames(truth.trajectory, input.recording.markers, truth_file);
      if (request.person.subject_file.empty()) {
        if (!request.person.size.height) request.person.size.height = truth.size.height;
        if (!request.person.size.mass) request.person.size.mass = truth.size.mass;
      }
    }
    ScaleTrialsModel(request, config, &input, &trial, warnings);
    trial.markers = std::move(input.recording.markers);
  } catch (const Error& error) {
    trial.failure = WithAdvice(error);
  }
  return trial;
}

std::vector<Option> Options(ComparisonOptions* options) {
  constexpr double kMost = std::numeric_limits<int>::max();
  const auto set_model = [options](const std::string& text) {
    options->hiding.model = text == "paper" ? HidingModel::kPaper : HidingModel::kStationary;
    return text == "paper" || text == "stationary";
  };
  const char* const group = "Comparison";
  const OptionNotes notes = {.absent = "a batch compares nothing"};
  return {
      Row({"hide", "", "hide"}, {OptionKind::kNumber, "P", "", 0, 1},
          "hide markers from the converters; errors are still taken over all markers", "",
          task::kCompare, &options->hiding.amount, notes, group),
      Row({"hide-model", "", "hide_model"}, {OptionKind::kChoice, "paper|stationary"},
          "paper (default): P is the probability with which a visible marker hides in a frame, for "
          "Poisson(100) frames; the paper has 0.005. stationary: a share P is hidden throughout",
          "", task::kCompare, set_model, notes, group),
      Row({"repeat", "", "repeat"}, {OptionKind::kWhole, "N", "", 1, 100000},
          "runs, each with other hidden markers", "1", task::kCompare, &options->runs, notes,
          group),
      Row({"seed", "", "seed"}, {OptionKind::kWhole, "N", "", 0, kMost},
          "of the first run; the next runs have the next seeds", "1", task::kCompare,
          &options->seed, notes, group),
      Row({"jobs", "", "jobs"}, {OptionKind::kWhole, "N", "", 0, 1024},
          "runs at a time. Only times depend on it: 1 leaves them undisturbed", "0, all cores",
          task::kCompare, &options->jobs, notes, group)};
}

void MakeNamesUnique(std::vector<Trial>* trials, std::vector<Contender>* contenders) {
  NumberRepeatedNames(trials);
  NumberRepeatedNames(contenders);
}

}  // namespace mmm_converter
