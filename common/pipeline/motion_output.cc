// SPDX-License-Identifier: MIT
#include "common/pipeline/motion_output.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "common/io/bytes/file_content.h"
#include "common/io/tables/osim_tables.h"
#include "common/support/advice.h"
#include "common/support/atomic_file.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

bool IsMmm2(const Recording& recording) { return recording.format == "MMM 2.0"; }

// The file's markers stay as they are if the motion is in the same coordinates.
bool AreMarkersAsInFile(const Recording& recording) {
  return recording.up_axis == UpAxis::kZ && recording.unit == "mm";
}

// The format has no place for a subject: players see the reference, scaled by height and mass.
std::string SubjectComment(const ConversionPlan& plan) {
  if (!plan.person.subject || plan.input.model->subject) return "";
  const auto name = [](const std::string& file) { return fs::path(file).filename().string(); };
  const std::string& file =
      plan.subject_output.empty() ? plan.person.subject_file : plan.subject_output;
  return fmt::format(
      "Root poses and joint angles are those of the subject {}{}, whose segment lengths and marker "
      "places differ from this model scaled by height and mass{}",
      plan.person.subject->name, file.empty() ? "" : " (" + name(file) + ")",
      plan.model_output.empty() ? "" : "; the subject's model: " + name(plan.model_output));
}

MmmMotionOutput MotionOf(const ConversionRequest& request, const ConversionReport& report) {
  MmmMotionOutput output = DescribeMotion(request, report.plan);
  output.trajectory = &report.result.trajectory;
  output.markers = &report.plan.input.recording.markers;
  return output;
}

TextPieces Format(const ConversionRequest& request, const std::vector<ConversionReport*>& reports) {
  ConversionReport& first = *reports.front();
  const Recording& recording = first.plan.input.recording;
  if (first.plan.output_format == "2.0" && IsMmm2(recording)) {
    std::vector<MmmMotionOutput> outputs;
    outputs.reserve(reports.size());
    for (const ConversionReport* report : reports) {
      MmmMotionOutput output = MotionOf(request, *report);
      output.motion_name = report->plan.input.recording.motion();
      if (AreMarkersAsInFile(report->plan.input.recording) && !report->plan.labels)
        output.markers = nullptr;
      outputs.push_back(std::move(output));
    }
    return WithConvertedMotions(BytesOfFile(request.input.file), request.input.file, outputs);
  }
  if (recording.mmm && recording.mmm->num_motions > 1) {
    first.warnings.Add(
        fmt::format("{}: has {} motions; the output has the converted one "
                    "only (MMM 2.0 in and out keeps all)",
                    request.input.file, recording.mmm->num_motions));
  }
  const MmmMotionOutput output = MotionOf(request, first);
  return first.plan.output_format == "1.0" ? FormatMmmMotion1(output) : FormatMmmMotion2(output);
}

bool IsNamedAsOfOpenSim(const fs::path& output) {
  return output.extension() == ".mot" || output.extension() == ".sto";
}

/// Of coordinates, in OpenSim's own format: the model has some, and the file's ending says so.
bool WritesCoordinates(const KinematicModel& model, const fs::path& output) {
  return model.coordinates() && IsNamedAsOfOpenSim(output);
}

std::string NameOf(const Recording& recording) {
  if (!recording.motion().empty()) return recording.motion();
  if (!recording.subject.empty()) return recording.subject;
  return fs::path(recording.file).stem().string();
}

}  // namespace

std::string DefaultOutput(const std::string& file, bool is_osim) {
  const fs::path input = file;
  return (input.parent_path() / (input.stem().string() + (is_osim ? ".mot" : "_mmm.xml"))).string();
}

bool IsOsimMotion(const ConversionPlan& plan) {
  return plan.setup.model && WritesCoordinates(*plan.setup.model, plan.output);
}

void CheckHoldsMotion(const ConversionPlan& plan) {
  const KinematicModel& model = *plan.input.reference;
  if (WritesCoordinates(model, plan.output)) return;
  if (IsNamedAsOfOpenSim(plan.output)) {
    throw Error(
        fmt::format("{}: the motion of such a model is an XML file of MMM; {} writes joint "
                    "angles for OpenSim",
                    plan.output, OptionText("export-mot")));
  }
  if (!model.coordinates() || !model.is_root_fixed()) return;
  throw Error(
      fmt::format("{}: MMM's motions are of a body that moves freely, and {} hangs on the "
                  "ground; give the output the ending .mot",
                  plan.output, model.name()));
}

void ChooseMotionOutput(const ConversionRequest& request, bool is_one_of_several,
                        ConversionPlan* plan) {
  const Recording& recording = plan->input.recording;
  plan->output_format =
      request.output_format.empty() ? plan->converter.config.output_format : request.output_format;
  const bool is_osim = plan->input.reference->coordinates() != nullptr;
  plan->output =
      request.output.empty() ? DefaultOutput(request.input.file, is_osim) : request.output;
  CheckHoldsMotion(*plan);
  if (is_one_of_several && WritesCoordinates(*plan->input.reference, plan->output)) {
    throw Error(fmt::format("{}: holds one motion; name it, or give the output the ending .xml",
                            plan->output));
  }
  std::error_code failure;
  const bool keeps_all = IsMmm2(recording) && plan->output_format != "1.0";
  if (!keeps_all && fs::equivalent(plan->output, request.input.file, failure)) {
    throw Error(
        fmt::format("{}: is the recording itself, which would be lost; give another file "
                    "with -o",
                    plan->output));
  }
  const std::string& wanted = is_one_of_several ? "" : request.motion_name;
  plan->motion_name = wanted.empty() ? NameOf(recording) : wanted;
}

MmmMotionOutput DescribeMotion(const ConversionRequest& request, const ConversionPlan& plan) {
  MmmMotionOutput output;
  output.recording_name = fs::path(request.input.file).stem().string();
  output.motion_name = plan.motion_name;
  output.model_path = !request.model_path.empty()
                          ? request.model_path
                          : ModelPathFor(plan.input.model_file, plan.output);
  output.height = plan.person.height.value;
  output.mass = plan.person.mass.value;
  output.hand_length = plan.person.hand_length;
  output.comment = SubjectComment(plan);
  return output;
}

std::string MotionFormat(const ConversionPlan& plan) {
  return IsOsimMotion(plan) ? "OpenSim" : "MMM " + plan.output_format;
}

std::string DeviationsOutput(const ConversionPlan& plan) {
  if (!IsOsimMotion(plan)) return "";
  const fs::path output = plan.output;
  return (output.parent_path() / (output.stem().string() + "_deviations.sto")).string();
}

void WriteMotions(const ConversionRequest& request, const std::vector<ConversionReport*>& reports) {
  const ConversionPlan& plan = reports.front()->plan;
  if (IsOsimMotion(plan)) {
    const PoseTrajectory& trajectory = reports.front()->result.trajectory;
    WriteFileAtomically(plan.output, FormatOsimMotion(*plan.setup.model, trajectory));
    if (trajectory.standard_deviations.array().isNaN().all()) return;
    WriteFileAtomically(DeviationsOutput(plan),
                        FormatOsimDeviations(*plan.setup.model, trajectory));
    return;
  }
  WriteFileAtomically(reports.front()->plan.output, Format(request, reports));
}

}  // namespace mmm_converter
