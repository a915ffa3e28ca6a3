// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/conversion_page.h"
#include "MMMConverterS2KF/report/conversion_summary.h"
#include "MMMConverterS2KF/report/json.h"
#include "MMMConverterS2KF/report/names_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/motion/marker_residuals.h"
#include "common/pipeline/all_motions.h"
#include "common/pipeline/conversion.h"
#include "common/pipeline/exporters.h"
#include "common/pipeline/force_exports.h"
#include "common/pipeline/input/osim_setup.h"
#include "common/pipeline/motion_output.h"
#include "common/pipeline/osim_scaling_run.h"
#include "common/support/atomic_file.h"
#include "common/support/output_plan.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

std::string DescribeModel(const ConversionReport& report) {
  if (!report.plan.object) {
    return fmt::format("{} joints", report.result.trajectory.joint_names.size());
  }
  const std::string file =
      report.plan.object->is_built() ? ": " + report.plan.input.model_file : "";
  return "object, " + DescribeObjectModel(*report.plan.object) + file;
}

std::string DescribeOutcome(const MotionOutcome& outcome) {
  if (!outcome.failure.empty()) return "not converted";
  if (!outcome.report) return "has no markers; left as it is";
  const ConversionReport& report = *outcome.report;
  const ResidualSummary& distance = report.figures.distance;
  return fmt::format("{} frames, {} markers, mean distance {:.1f} mm, max {:.1f}; {}; {}",
                     report.plan.input.recording.markers.num_frames(),
                     report.plan.setup.assignments().size(), kMillimetres * distance.mean,
                     kMillimetres * distance.max, DescribeModel(report),
                     DescribeVerdict(report.verdict));
}

/// A line for each motion of a file, and one for the file.
std::string FormatAllMotions(const AllMotions& all) {
  std::size_t width = 0;
  for (const MotionOutcome& outcome : all.motions) width = std::max(width, outcome.name.size());
  std::string text;
  for (const MotionOutcome& outcome : all.motions) {
    text += fmt::format("{:<{}}  {}\n", outcome.name, width, DescribeOutcome(outcome));
  }
  return text + fmt::format("written to {}\n", all.output);
}

/// As JSON: the summary of each motion, or why there is none.
Json ToJson(const AllMotions& all) {
  Json motions = Json::array();
  for (const MotionOutcome& outcome : all.motions) {
    motions.push_back({{"name", outcome.name},
                       {"failure", TextOrNull(outcome.failure)},
                       {"summary", outcome.report ? ToJson(*outcome.report) : Json(nullptr)}});
  }
  return {{"output", all.output}, {"motions", motions}};
}

const OptionGroup kConvertFiles = {
    "Files",
    {{"output,o", "FILE", "the motion; default: INPUT without its ending + _mmm.xml",
      "outputMotion"},
     {"report", "FILE", "write a page (HTML) with player and plots", ""},
     {"summary", "FILE", "write a summary as JSON", ""},
     {"setup", "FILE",
      "an OpenSim set-up (InverseKinematicsTool, ScaleTool, InverseDynamicsTool): recording, "
      "model, "
      "weights, time range and loads, where no option says them",
      ""},
     {"marker-set-out", "FILE",
      "write the marker set that was used, as the names of the labels gave it, for --marker-set",
      ""}}};

const OptionGroup kCalibration = {
    "Calibration",
    {{"subject-out", "FILE", "with --self-calibrate: also write the person", ""},
     {"model-out", "FILE", "of a calibrated person: also write the model, for other MMM programs",
      ""}}};

constexpr const char* kAllMotions = "all";
constexpr const char* kGait = "gait";

constexpr const char* kConvertUsage = R"(MMMConverterS2KF convert INPUT... [options]
Converts the markers of INPUT (C3D, TRC, or an MMM motion with markers) into an MMM motion.
Several recordings of a person are written one by one; --report is one page of all of them, with the
strides of all together, --export-gait one table.
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
  MMMConverterS2KF convert walk.c3d run.c3d --subject-file anna.xml --report anna.html
  MMMConverterS2KF convert walk.c3d run.c3d jump.c3d --condition bare,bare,shoes --report b.html
  MMMConverterS2KF convert recording.xml --motion 1723 -o recording.xml
  MMMConverterS2KF convert recording.xml --motion all --object-models objects -o converted.xml
  MMMConverterS2KF convert cup.c3d --object --object-models objects
  MMMConverterS2KF convert walk.c3d --frames 100:400 -c my.xml --format 1.0
  MMMConverterS2KF convert walk.c3d --height 1.75 --export-trc walk.trc --export-mot walk.mot
  MMMConverterS2KF convert --setup walk_Setup_IK.xml --export-mot walk.mot
)";

std::string ChooseInput(const Arguments& arguments) {
  const auto legacy = arguments.Get("inputMotion");
  if (legacy && arguments.positional()) {
    throw UsageError(fmt::format("convert: one input only, but there are \"{}\" and \"{}\"",
                                 *arguments.positional(), *legacy));
  }
  if (legacy) return *legacy;
  if (arguments.positional()) return *arguments.positional();
  if (arguments.Has("setup")) return "";
  throw UsageError(
      "convert: which recording? For instance: MMMConverterS2KF convert walk.c3d "
      "--height 1.75");
}

ConversionRequest MakeConversionRequest(const Arguments& arguments, const std::string& input) {
  ConversionRequest request = MakeRequest(task::kConvert, arguments, input);
  if (const auto setup = arguments.Get("setup")) {
    Warnings warnings;
    FillFromOsimSetup(*setup, &request.input, &warnings);
    LogWarnings(warnings);
  }
  request.output = arguments.Get("output").value_or("");
  request.subject_output = arguments.Get("subject-out").value_or("");
  request.model_output = arguments.Get("model-out").value_or("");
  if (!request.self_calibrate && !request.subject_output.empty()) {
    throw UsageError("convert: --subject-out needs --self-calibrate, which estimates the subject");
  }
  request.exports = ExportsOf(arguments);
  for (const char* option : {"summary", "report", "marker-set-out"}) {
    if (const auto file = arguments.Get(option)) request.more_outputs.push_back(*file);
  }
  return request;
}

// What has a place for one motion only.
void CheckFitsAllMotions(const Arguments& arguments) {
  std::vector<std::string> options = {"object",      "label",     "repair",        "model-path",
                                      "subject-out", "model-out", "marker-set-out"};
  for (const Exporter& exporter : Exporters()) options.emplace_back(exporter.option);
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

// Gives each recording its condition, in their order, or all of them the only one.
void SpreadConditions(std::vector<ConversionRequest>* requests) {
  const std::vector<std::string> conditions = Split(requests->front().input.patient.condition, ',');
  if (conditions.size() == 1) return;
  if (conditions.size() != requests->size()) {
    throw UsageError(fmt::format(
        "convert: --condition names {} conditions of {} recordings; name one for all, or one for "
        "each in their order",
        conditions.size(), requests->size()));
  }
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    (*requests)[i].input.patient.condition = conditions[i];
  }
}

// Each is written where it would be alone; the page has all of them.
int ConvertSeveral(const Arguments& arguments) {
  std::vector<std::string> options = {"output",      "summary",   "marker-set-out",
                                      "subject-out", "model-out", "inputMotion"};
  for (const Exporter& exporter : Exporters()) {
    if (exporter.name != std::string_view(kGait)) options.emplace_back(exporter.option);
  }
  for (const std::string& option : options) {
    if (!arguments.Has(option)) continue;
    throw UsageError(fmt::format(
        "convert: --{} is of one recording, but there are {}; batch has a place for all", option,
        arguments.positionals().size()));
  }
  std::vector<ConversionRequest> requests;
  OutputPlan plan;
  std::set<std::filesystem::path> named;
  for (const std::string& file : arguments.positionals()) {
    std::error_code failure;
    const auto canonical = std::filesystem::weakly_canonical(file, failure);
    if (!named.insert(failure ? std::filesystem::path(file) : canonical).second) {
      throw UsageError(fmt::format("convert: {} is named twice", file));
    }
    requests.push_back(MakeConversionRequest(arguments, file));
    if (requests.back().motion_name == kAllMotions) {
      throw UsageError("convert: --motion all is of one file");
    }
    plan.Read(file);
    plan.Write(DefaultOutput(file, IsOsimModel(requests.back().input)));
  }
  SpreadConditions(&requests);
  plan.Write(arguments.Get("report").value_or(""));
  const ExportFiles exports = requests.front().exports;  // the strides of all
  NameOutputs(exports, &plan);
  plan.Check();
  std::vector<ConversionReport> reports;
  std::vector<std::string> failures;
  for (ConversionRequest& request : requests) {
    ProgressBar bar("frames");
    const auto progress = [&](int done, int all) {
      bar.Show(done, all);
      return true;
    };
    try {
      ConversionReport report = RunConversion(request, LabelFirst(request, {}, progress), progress);
      bar.Clear();
      request.exports.clear();
      WriteConversion(request, &report);
      LogWarnings(report.warnings);
      std::cout << (reports.empty() ? "" : "\n") << FormatSummary(report);
      reports.push_back(std::move(report));
    } catch (const Error& error) {
      bar.Clear();
      LogError(WithAdvice(error));
      failures.push_back(error.what());
    }
  }
  std::vector<const ConversionReport*> all;
  all.reserve(reports.size());
  for (const ConversionReport& report : reports) all.push_back(&report);
  Verdict together;
  for (std::string& doubt : DoubtsTogether(all)) AddDoubt(std::move(doubt), &together);
  if (!together.reasons.empty()) {
    std::cout << fmt::format("\ntogether   {} recordings\n", all.size()) << FormatVerdict(together);
  }
  if (const auto file = arguments.Get("report"); file && !reports.empty()) {
    WriteFileAtomically(*file, FormatConversionPage(all, failures));
  }
  if (const auto gait = exports.find(kGait); gait != exports.end() && !reports.empty()) {
    WriteGaitOf(gait->second, all);
  }
  std::vector<Verdict::Level> verdicts;
  verdicts.reserve(reports.size());
  for (const ConversionReport& report : reports) verdicts.push_back(report.verdict.level);
  return failures.empty() ? ExitCodeOf(arguments, verdicts) : 1;
}

int ConvertAllMotions(const Arguments& arguments, const ConversionRequest& request) {
  CheckFitsAllMotions(arguments);
  ProgressBar bar("frames");
  AllMotions all = RunAllMotions(request, [&](int done, int frames) {
    bar.Show(done, frames);
    return true;
  });
  bar.Clear();
  FilesTogether files;
  WriteAllMotions(request, &all);
  LogWarningsOf(all);
  std::vector<std::string> failures;
  for (const MotionOutcome& one : all.motions) {
    if (!one.failure.empty())
      failures.push_back(fmt::format("motion {}: {}", one.name, one.failure));
  }
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(all)));
  }
  const auto reports = ReportsOf(all);
  if (const auto file = arguments.Get("report"); file && !reports.empty()) {
    WriteFileAtomically(*file, FormatConversionPage(reports, failures));
  }
  files.Commit();
  std::cout << FormatAllMotions(all);
  for (const std::string& failure : failures) LogError(failure);
  std::vector<Verdict::Level> verdicts;
  verdicts.reserve(reports.size());
  for (const ConversionReport* report : reports) verdicts.push_back(report->verdict.level);
  return failures.empty() ? ExitCodeOf(arguments, verdicts) : 1;
}

}  // namespace

Manual ConvertManual() {
  std::vector<OptionGroup> options = CommandOptions(
      task::kConvert, {kConvertFiles}, {kCalibration, ExportGroup("Export", Exporters())});
  options.push_back({"", {{"inputMotion", "FILE", "", ""}}});
  return {kConvertUsage, std::move(options), true};
}

int RunConvert(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  if (arguments.positionals().size() > 1) return ConvertSeveral(arguments);
  const ConversionRequest request = MakeConversionRequest(arguments, ChooseInput(arguments));
  if (request.motion_name == kAllMotions) return ConvertAllMotions(arguments, request);
  ProgressBar bar("frames");
  const auto progress = [&](int done, int all) {
    bar.Show(done, all);
    return true;
  };
  ConversionReport report = RunConversion(request, LabelFirst(request, {}, progress), progress);
  bar.Clear();
  FilesTogether files;
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
  files.Commit();
  std::cout << FormatSummary(report);
  return ExitCodeOf(arguments, {report.verdict.level});
}

}  // namespace mmm_converter
