// SPDX-License-Identifier: MIT
#include "common/pipeline/live_plan.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/pipeline/motion_output.h"
#include "common/pipeline/object.h"
#include "common/support/advice.h"
#include "common/support/error.h"
#include "common/support/opened_files.h"

namespace mmm_converter {

namespace {

// As of a recording that is converted.
std::string NameOf(const LiveRequest& request, const Recording& head) {
  for (const std::string& name : {request.motion_name, head.motion(), head.subject}) {
    if (!name.empty()) return name;
  }
  return head.format == "live stream" ? "live" : std::filesystem::path(head.file).stem().string();
}

// A given model without joints is a rigid object's: it is tracked as it is.
void UseObject(const LiveRequest& request, const Recording& head, ConversionPlan* plan) {
  if (request.input.model_file.empty() || plan->input.reference->num_joints() > 0) return;
  if (request.calibration_time > 0 || request.label || IsGiven(request.input.person)) {
    throw Error(fmt::format(
        "{} has no joints, and is tracked as a rigid object; {}, {}, {} and others are of a person",
        request.input.model_file, OptionText("height"), OptionText("label"),
        OptionText("self-calibrate")));
  }
  ObjectRequest object;
  object.name = NameOf(request, head);
  object.has_model_given = true;
  plan->object = FindObject(object, plan->input, plan->converter.config, &plan->warnings);
  UseModel(*plan->object, &plan->input);
  plan->converter.config = ConfigOfObject(plan->input, plan->converter.config);
}

}  // namespace

ConversionPlan PlanLive(const LiveRequest& request, const Recording& head) {
  const OpenedFiles opened;
  ConversionPlan plan;
  Warnings* warnings = &plan.warnings;
  plan.input = ReadModel(request.input, {}, warnings);
  plan.input.recording = head;
  plan.converter = ChosenConverter(request.converter, {}, warnings);
  ConverterConfig& config = plan.converter.config;
  MatchModel(request.input, &plan.input, &config);
  if (request.calibration_time > 0) config.subject_file.clear();
  UseObject(request, head, &plan);
  const Recording& recording = plan.input.recording;
  if (request.label) {
    plan.labels = FindNames(request.input, plan.input, config, warnings);
    plan.input.recording.markers =
        MarkerSequence(plan.labels->labelling.names, 1, head.markers.rate(), 0);
  }
  // Of a stream any label may be seen later.
  const bool is_whole = head.format == "replay" && !request.label;
  const std::vector<std::string>& labels = recording.markers.labels();
  PlanBody(request,
           is_whole ? LabelsOf(recording.markers, recording.file)
                    : MarkerLabels{labels, {}, recording.file},
           &plan);
  if (request.calibration_time > 0 && config.model_processor == "None") {
    throw Error(WhyUnscaled(config) + ", but a subject is relative to the scaled one");
  }
  plan.output = request.output;
  plan.output_format = request.output_format.empty() ? config.output_format : request.output_format;
  if (!plan.output.empty() && request.robot.file.empty()) CheckHoldsMotion(plan);
  plan.motion_name = NameOf(request, head);
  plan.subject_output = request.subject_output;
  plan.opened = opened.files();
  return plan;
}

LiveCalibration CalibrateLive(const ConversionPlan& plan, const MarkerSequence& frames) {
  LiveCalibration calibration;
  calibration.person = plan.person;
  calibration.setup = plan.setup;
  TrackingSetup& setup = calibration.setup;
  calibration.result =
      CalibratePerson(*setup.model, setup.joints, {{"the stream", &frames, setup.assignments()}},
                      plan.person, plan.motion_name, &calibration.warnings);
  calibration.person.subject = std::make_shared<Subject>(calibration.result.subject);
  setup.model = std::make_shared<KinematicModel>(
      ScaleModel(*plan.input.reference, ScalingOf(calibration.person, plan.converter.config)));
  return calibration;
}

std::unique_ptr<MotionConverter> MakeConverter(const ConversionPlan& plan,
                                               const TrackingSetup& setup) {
  return plan.converter.plugin->factory().Create(setup, plan.converter.config);
}

}  // namespace mmm_converter
