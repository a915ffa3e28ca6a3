// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/report/all_motions_summary.h"
#include "MMMConverterS2KF/report/conversion_page.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/names_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/input_options.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/pipeline/all_motions.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/exporters.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

const OptionGroup kFileOptions = {
    "Files",
    {{"output,o", "FILE", "the motion; default: INPUT without its ending + _mmm.xml",
      "outputMotion"},
     {"format", "2.0|1.0", "of the motion; default: what the configuration says, 2.0", ""},
     {"report", "FILE", "write a page (HTML) with player and plots", ""},
     {"summary", "FILE", "write a summary as JSON", ""},
     {"marker-set-out", "FILE",
      "write the marker set that was used, as the names of the labels gave it, for --marker-set",
      ""},
     {"model-path", "PATH",
      "path of the model that is written into the motion; default: relative to the motion", ""}}};

const std::vector<OptionGroup> kOtherOptions = {
    {"Converter",
     {{"config,c", "FILE", "configuration, or the name of a shipped one; default: s2kf_default",
       "converterConfigFile"},
      {"converter", "NAME", "default: what the configuration says, else S2KFConverter", ""},
      {"plugin", "FILE", "take the converter from this plugin file", ""}}},
    {"Labels",
     {{"label", "",
       "find the names of points that have none first, as label does: by --subject-file, or by "
       "--height and --marker-set",
       ""},
      {"like", "RECORDING",
       "with --label: by the labels of another recording of the person with these markers, too",
       ""},
      {"and-subject-file", "FILE",
       "with --label: another person who is there too and is not converted, calibrated; for each "
       "of them. Rigid objects that may be there are those of --object-models",
       "", true},
      {"repair", "",
       "correct wrong labels first, as label --repair does; nothing is written but the motion",
       ""}}},
    {"Calibration",
     {{"self-calibrate", "",
       "estimate segment lengths and marker places from this recording first, as calibrate does",
       ""},
      {"subject-out", "FILE", "with --self-calibrate: also write the person", ""},
      {"model-out", "FILE", "of a calibrated person: also write the model, for other MMM programs",
       ""}}},
    {"Objects",
     {{"object", "",
       "the recording shows a rigid object, not a person; MMM motions state this themselves", ""},
      {"object-models", "DIR",
       "models of rigid objects, DIR/MOTION.xml each; one that is missing is built from its "
       "motion's markers and written there; default: all are built, into OUTPUT without ending + "
       "_objects",
       ""}}},
    {"General",
     {{"log", "LEVEL", "off, error, warning, info or debug; default: info", ""},
      {"help,h", "", "print this help", ""}}}};

constexpr const char* kAllMotions = "all";

constexpr const char* kUsage = R"(MMMConverterS2KF convert INPUT [options]
Converts the markers of INPUT (C3D, TRC, or an MMM motion with markers) into an MMM motion.
The other motions of an MMM 2.0 file are kept, and -o may then be INPUT. --motion all converts every
motion that has markers: persons with the reference model, each rigid object with its own model.

{}MMMMotionConverter's options --inputMotion, --motionName, --converterConfigFile, --outputModelFile,
--outputModelProcessorConfigFile and --outputMotion stand for INPUT, --motion, -c, --model, --person
and -o.

Examples
  MMMConverterS2KF convert walk.c3d --height 1.75
  MMMConverterS2KF convert walk.c3d --height 1.75 --mass 70 -o walk.xml --summary walk.json
  MMMConverterS2KF convert walk.c3d --height 1.75 --self-calibrate --subject-out anna.xml
  MMMConverterS2KF convert run.c3d --subject-file anna.xml
  MMMConverterS2KF convert unlabelled.c3d --label --subject-file anna.xml
  MMMConverterS2KF convert both.c3d --label --subject-file anna.xml --and-subject-file ben.xml
  MMMConverterS2KF convert unlabelled.c3d --label --like standing.c3d --height 1.68
  MMMConverterS2KF convert recording.xml --motion 1723 -o recording.xml
  MMMConverterS2KF convert recording.xml --motion all --object-models objects -o converted.xml
  MMMConverterS2KF convert cup.c3d --object --object-models objects
  MMMConverterS2KF convert walk.c3d --frames 100:400 -c my.xml --format 1.0
  MMMConverterS2KF convert walk.c3d --height 1.75 --export-trc walk.trc --export-mot walk.mot
)";

std::vector<OptionGroup> Options() {
  OptionGroup exports = {"Export", {}};
  for (const Exporter& exporter : Exporters()) {
    exports.options.push_back({OptionOf(exporter), "FILE", exporter.help, ""});
  }
  std::vector<OptionGroup> options = {kFileOptions};
  options.insert(options.end(), InputOptions().begin(), InputOptions().end());
  options.push_back(std::move(exports));
  options.insert(options.end(), kOtherOptions.begin(), kOtherOptions.end());
  return options;
}

std::string ChooseInput(const Arguments& arguments) {
  const auto legacy = arguments.Get("inputMotion");
  if (legacy && arguments.positional()) {
    throw UsageError(fmt::format("convert: one input only, but there are \"{}\" and \"{}\"",
                                 *arguments.positional(), *legacy));
  }
  if (legacy) return *legacy;
  if (arguments.positional()) return *arguments.positional();
  throw UsageError(
      "convert: which recording? For instance: MMMConverterS2KF convert walk.c3d "
      "--height 1.75");
}

void TakeLabels(const Arguments& arguments, ConversionRequest* request) {
  request->label_hints.like = arguments.Get("like").value_or("");
  request->label_hints.repair = arguments.Has("repair");
  request->label = arguments.Has("label") || request->label_hints.repair;
  if (request->label && request->is_object) {
    throw UsageError("convert: --label names the markers of a person, not those of an --object");
  }
  request->label_hints.other_persons = arguments.GetAll("and-subject-file");
  if (request->label) {
    request->label_hints.object_models = arguments.Get("object-models").value_or("");
    return;
  }
  if (!request->label_hints.like.empty()) {
    throw UsageError("convert: --like says by which recording --label or --repair finds names");
  }
  if (!request->label_hints.other_persons.empty()) {
    throw UsageError("convert: --and-subject-file says who else wears the points of a --label");
  }
}

ConversionRequest MakeRequest(const Arguments& arguments) {
  ConversionRequest request;
  request.input = MakeInputRequest(arguments, ChooseInput(arguments));
  request.output = arguments.Get("output").value_or("");
  if (arguments.Has("format"))
    request.output_format = arguments.GetChoice("format", {"2.0", "1.0"}, "");
  request.motion_name = request.input.reading.motion;
  request.model_path = arguments.Get("model-path").value_or("");
  request.self_calibrate = arguments.Has("self-calibrate");
  request.subject_output = arguments.Get("subject-out").value_or("");
  request.model_output = arguments.Get("model-out").value_or("");
  request.is_object = arguments.Has("object");
  TakeLabels(arguments, &request);
  request.object_models = arguments.Get("object-models").value_or("");
  if (request.self_calibrate && !request.input.person.subject_file.empty()) {
    throw UsageError(
        "convert: --self-calibrate estimates the person, --subject-file says who it is; use one");
  }
  if (!request.self_calibrate && !request.subject_output.empty()) {
    throw UsageError("convert: --subject-out needs --self-calibrate, which estimates the subject");
  }
  for (const Exporter& exporter : Exporters()) {
    if (const auto file = arguments.Get(OptionOf(exporter))) request.exports[exporter.name] = *file;
  }
  for (const char* option : {"summary", "report", "marker-set-out"}) {
    if (const auto file = arguments.Get(option)) request.more_outputs.push_back(*file);
  }
  request.converter = {arguments.Get("config").value_or(""),
                       arguments.Get("converter").value_or(""),
                       arguments.Get("plugin").value_or("")};
  return request;
}

// What has a place for one motion only.
void CheckFitsAllMotions(const Arguments& arguments) {
  std::vector<std::string> options = {"object",      "label",     "repair",        "model-path",
                                      "subject-out", "model-out", "marker-set-out"};
  for (const Exporter& exporter : Exporters()) options.push_back(OptionOf(exporter));
  for (const std::string& option : options) {
    if (!arguments.Has(option)) continue;
    throw UsageError(fmt::format(
        "convert: --{} is for one motion, not for --motion all; use --motion NAME", option));
  }
}

void LogWarningsOf(const AllMotions& all) {
  LogWarnings(all.warnings);
  for (const MotionOutcome& outcome : all.motions) {
    if (!outcome.report) continue;
    for (const std::string& warning : outcome.report->warnings.texts()) {
      LogWarning(fmt::format("motion {}: {}", outcome.name, warning));
    }
  }
}

int ConvertAllMotions(const Arguments& arguments, const ConversionRequest& request) {
  CheckFitsAllMotions(arguments);
  ProgressBar bar("frames");
  AllMotions all = RunAllMotions(request, [&](int done, int frames) {
    bar.Show(done, frames);
    return true;
  });
  bar.Clear();
  WriteAllMotions(request, &all);
  LogWarningsOf(all);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(all)));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatConversionPage(ReportsOf(all)));
  }
  std::cout << FormatAllMotions(all);
  int failures = 0;
  for (const MotionOutcome& outcome : all.motions) {
    if (outcome.failure.empty()) continue;
    LogError(fmt::format("motion {}: {}", outcome.name, outcome.failure));
    ++failures;
  }
  return failures == 0 ? 0 : 1;
}

}  // namespace

Manual ConvertManual() {
  std::vector<OptionGroup> options = Options();
  options.push_back({"", {{"inputMotion", "FILE", "", ""}}});
  return {kUsage, std::move(options)};
}

int RunConvert(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  const ConversionRequest request = MakeRequest(arguments);
  if (request.motion_name == kAllMotions) return ConvertAllMotions(arguments, request);
  ProgressBar bar("frames");
  const auto progress = [&](int done, int all) {
    bar.Show(done, all);
    return true;
  };
  ConversionReport report = RunConversion(request, LabelFirst(request, {}, progress), progress);
  bar.Clear();
  WriteConversion(request, &report);
  LogWarnings(report.warnings);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report)));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatConversionPage({&report}));
  }
  if (const auto file = arguments.Get("marker-set-out")) {
    WriteFileAtomically(*file, FormatUsedSet(report.plan));
  }
  std::cout << FormatSummary(report);
  return 0;
}

}  // namespace mmm_converter
