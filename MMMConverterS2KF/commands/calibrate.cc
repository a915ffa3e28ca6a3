// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/comparison_output.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/calibration_summary.h"
#include "MMMConverterS2KF/report/osim_scaling_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/io/mmm/mmm_model_subject.h"
#include "common/io/mmm/subject_file.h"
#include "common/pipeline/comparison/comparison_setup.h"
#include "common/pipeline/osim_scaling_run.h"
#include "common/pipeline/person_calibration.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

const OptionGroup kCalibrateFiles = {
    "Files",
    {{"output,o", "FILE",
      "the subject; default: RECORDING without its ending + _subject.xml, or _scaled.osim", ""},
     {"scale-setup", "FILE",
      "a ScaleTool set-up of OpenSim: scale the .osim of --model by the recording as it says", ""},
     {"model-out", "FILE", "also write the person's model, for other MMM programs", ""},
     {"report", "FILE", "write a page (HTML): the recordings converted with the subject", ""},
     {"summary", "FILE", "write a summary as JSON", ""},
     {"name", "NAME", "of the person; default: what the first recording calls it", ""}}};

constexpr const char* kCalibrateUsage = R"(MMMConverterS2KF calibrate RECORDING... [options]
Estimates the lengths of a person's segments and the places of the markers on the body. Any motions
of the person can be used; the more the joints move, the better. Markers must not be attached again
between these recordings and those that are converted with the result. What the recordings do not
determine keeps the values of the scaled model. Use the result with convert --subject-file.

With a model of OpenSim (--model generic.osim) the result is the person's model: sizes of bodies
along their axes and places of all markers from these recordings, masses by --mass, everything else
as it was. Deviations are in the summary, and in a comment of the model that convert --model reads.
With --scale-setup, OpenSim's own rules are followed instead.

{}The options frames, subject, motion, unit, rate and up are given once for all recordings, or once
for each recording in the same order.

Examples
  MMMConverterS2KF calibrate range_of_motion.c3d --height 1.75 -o anna.xml
  MMMConverterS2KF calibrate walk.c3d jump.c3d --height 1.75 -o anna.xml --report anna.html
  MMMConverterS2KF convert run.c3d --subject-file anna.xml -o run_mmm.xml
  MMMConverterS2KF calibrate static.trc walk.trc --model generic.osim --mass 68 -o anna.osim
  MMMConverterS2KF calibrate static.trc --model generic.osim --scale-setup setup.xml -o anna.osim
)";

constexpr const char* kSubjectEnding = "_subject.xml";

// Given once for all recordings, or once for each in their order.
const std::vector<std::string> kCalibratePerRecording = {"frames", "subject", "motion",
                                                         "unit",   "rate",    "up"};

CalibrationRequest MakeCalibrationRequest(const Arguments& arguments) {
  CalibrationRequest request;
  request.inputs = MakeInputs(task::kCalibrate, arguments, kCalibratePerRecording);
  request.converter = MakeRequest(task::kCalibrate, arguments, "").converter;
  request.name = arguments.Get("name").value_or("");
  return request;
}

std::string CalibrateOutputFile(const Arguments& arguments, const char* ending) {
  if (const auto file = arguments.Get("output")) return *file;
  const std::filesystem::path input = arguments.positionals().front();
  return (input.parent_path() / (input.stem().string() + ending)).string();
}

void CheckOutputs(const Arguments& arguments, const CalibrationRequest& request,
                  const ConverterChoice& choice) {
  OutputPlan plan;
  for (const InputRequest& input : request.inputs) NameInputs(input, &plan);
  NameInputs(choice, &plan);
  plan.Write(CalibrateOutputFile(arguments, kSubjectEnding));
  for (const char* output : {"model-out", "report", "summary"}) {
    plan.Write(arguments.Get(output).value_or(""));
  }
  plan.Check();
}

// Each recording converted with the person. before: what the model was without.
std::string FormatCalibrationReport(const Arguments& arguments,
                                    const std::vector<CalibrationInput>& recordings,
                                    const std::shared_ptr<const KinematicModel>& model,
                                    const CalibrationResult& result, const std::string& before) {
  const auto subject = std::make_shared<const Subject>(result.subject);
  std::vector<Trial> trials;
  trials.reserve(recordings.size());
  for (const CalibrationInput& one : recordings) {
    Trial trial;
    trial.name = std::filesystem::path(one.input.recording.file).filename().string();
    trial.markers = one.input.recording.markers;
    trial.model = model;
    trial.subject = subject;
    trials.push_back(std::move(trial));
  }
  Contender contender = MakeContender(arguments.Get("config").value_or(""));
  InputRequest request;
  request.marker_set = arguments.Get("marker-set").value_or("");
  UseMarkerSet(request, &contender.config);
  const std::string text = fmt::format(
      "The person \"{}\", calibrated on {} frames: the best postures leave {:.1f} mm to the "
      "markers where {} leaves {:.1f}. Below, the recordings are converted with it.",
      subject->name, result.frames, 1e3 * result.distance_after, before,
      1e3 * result.distance_before);
  return FormatPageOfRuns("Calibration of " + subject->name, text, std::move(trials),
                          std::move(contender));
}

constexpr const char* kOsimEnding = "_scaled.osim";

void CheckOsimOptions(const Arguments& arguments) {
  if (arguments.Get("model-out")) {
    throw UsageError(
        "calibrate --model-out: -o is the person's model where one of OpenSim is given");
  }
  for (const char* option : {"report", "name"}) {
    if (!arguments.Get("scale-setup") || !arguments.Get(option)) continue;
    throw UsageError(fmt::format("calibrate --scale-setup: --{} is of a calibration", option));
  }
}

int WriteOsim(const Arguments& arguments, const OsimScalingReport& report,
              const std::string& output, FilesTogether* files) {
  LogWarnings(report.warnings);
  WriteFileAtomically(output, report.scaled.content);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report, output)));
  }
  files->Commit();
  std::cout << FormatOsimScalingSummary(report, output);
  return report.verdict ? ExitCodeOf(arguments, {report.verdict->level}) : 0;
}

// A model of OpenSim instead of a subject.
int ScaleOsimModel(const Arguments& arguments, const std::string& setup_file) {
  if (arguments.positionals().size() != 1) {
    throw UsageError("calibrate --scale-setup: one recording is expected, of the person standing");
  }
  CheckOsimOptions(arguments);
  const OsimScalingRequest request = {
      MakeInputs(task::kCalibrate, arguments, kCalibratePerRecording).front(), setup_file};
  const std::string output = CalibrateOutputFile(arguments, kOsimEnding);
  OutputPlan plan;
  NameInputs(request, &plan);
  plan.Write(output);
  plan.Write(arguments.Get("summary").value_or(""));
  plan.Check();
  const OsimScalingReport report = RunOsimScaling(request);
  plan.Check();
  FilesTogether files;
  return WriteOsim(arguments, report, output, &files);
}

int CalibrateOsimModel(const Arguments& arguments, const CalibrationRequest& request) {
  CheckOsimOptions(arguments);
  const std::string output = CalibrateOutputFile(arguments, kOsimEnding);
  Warnings of_choice;
  const ConverterChoice choice = ChooseConverter(request.converter, &of_choice);
  OutputPlan plan;
  for (const InputRequest& input : request.inputs) NameInputs(input, &plan);
  NameInputs(choice, &plan);
  plan.Write(output);
  plan.Write(arguments.Get("summary").value_or(""));
  plan.Write(arguments.Get("report").value_or(""));
  plan.Check();
  ProgressBar bar("recordings read");
  const OsimScalingReport report =
      RunOsimCalibration(request, {choice.config, std::move(of_choice)},
                         [&](int done, int all) { bar.Show(done, all); });
  bar.Clear();
  plan.Check();
  FilesTogether files;
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatCalibrationReport(arguments, report.recordings, report.model,
                                                       *report.result, "the model of that size"));
  }
  return WriteOsim(arguments, report, output, &files);
}

}  // namespace

Manual CalibrateManual() {
  return {kCalibrateUsage,
          CommandOptions(task::kCalibrate, {kCalibrateFiles}, {}, kCalibratePerRecording), true};
}

int RunCalibrate(const Arguments& arguments) {
  if (arguments.positionals().empty()) {
    throw UsageError(
        "calibrate: which recordings? For instance: MMMConverterS2KF calibrate walk.c3d --height "
        "1.75 -o anna.xml");
  }
  StartLog(arguments.Get("log").value_or("info"));
  if (const auto setup = arguments.Get("scale-setup")) return ScaleOsimModel(arguments, *setup);
  const CalibrationRequest request = MakeCalibrationRequest(arguments);
  if (IsOsimModel(request.inputs.front())) return CalibrateOsimModel(arguments, request);
  const std::string output = CalibrateOutputFile(arguments, kSubjectEnding);
  Warnings of_choice;
  const ConverterChoice choice = ChooseConverter(request.converter, &of_choice);
  CheckOutputs(arguments, request, choice);
  ProgressBar bar("recordings read");
  const CalibrationReport report = RunCalibration(request, {choice.config, std::move(of_choice)},
                                                  [&](int done, int all) { bar.Show(done, all); });
  bar.Clear();
  CheckOutputs(arguments, request, choice);
  LogWarnings(report.warnings);
  FilesTogether files;
  const std::string& model_file = report.recordings.front().input.model_file;
  const Subject& subject = report.result.subject;
  if (const auto file = arguments.Get("model-out")) {
    WriteFileAtomically(*file, ReadModelForSubject(model_file, subject));
  }
  WriteFileAtomically(output, FormatSubject(subject, SubjectProgram()));
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report, output)));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(
        *file, FormatCalibrationReport(arguments, report.recordings, report.model, report.result,
                                       "the model scaled by height"));
  }
  files.Commit();
  std::cout << FormatCalibrationSummary(report, output);
  return ExitCodeOf(arguments, {report.verdict.level});
}

}  // namespace mmm_converter
