// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/report/retarget_page.h"
#include "MMMConverterS2KF/report/retarget_summary.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/progress.h"
#include "common/io/robot/robot_exports.h"
#include "common/pipeline/dynamics/retarget_run.h"
#include "common/support/atomic_file.h"

namespace mmm_converter {
namespace {

const std::vector<OptionGroup> kRetargetOptions = {
    {"Files",
     {{"output,o", "FILE",
       "the robot's motion, MMM 2.0; default: INPUT without its ending + _robot.xml", ""},
      {"summary", "FILE", "write all figures as JSON", ""},
      {"report", "FILE",
       "write a page (HTML) with both bodies side by side, contacts, joints and limits; without "
       "INPUT of a made motion, which shows the map",
       ""}}},
    {"Robot",
     {{"print-map", "", "print which joints are the limbs; without INPUT nothing else is done",
       ""}}}};

std::vector<OptionGroup> RetargetOptions() {
  std::vector<OptionGroup> groups = kRetargetOptions;
  OptionGroup exports{"Robot learning", {}};
  for (const RobotExporter& format : RobotExporters()) {
    exports.options.push_back({format.option, "FILE", format.help, ""});
  }
  groups.push_back(std::move(exports));
  return groups;
}

struct RobotExport {
  const RobotExporter* format = nullptr;
  std::string file;
};

std::vector<RobotExport> ExportsOf(const Arguments& arguments, const RobotRequest& robot) {
  std::vector<RobotExport> exports;
  for (const RobotExporter& format : RobotExporters()) {
    const auto file = arguments.Get(format.option);
    if (!file) continue;
    if (format.needs_order && robot.order.empty()) {
      throw UsageError(fmt::format(
          "--{} needs --order isaac or --order mujoco: no reader of the file can tell which it is",
          format.option));
    }
    exports.push_back({&format, *file});
  }
  for (const char* idle : {"export-rate", "order"}) {
    if (exports.empty() && arguments.Get(idle)) {
      throw UsageError(fmt::format("--{} is of an export, and none is asked for", idle));
    }
  }
  return exports;
}

constexpr const char* kRetargetUsage =
    R"(MMMConverterS2KF retarget INPUT --robot ROBOT [options]
Brings the motion of a person to a humanoid robot. INPUT is a recording, which is converted first
as convert does, or a finished MMM motion. Feet stand still where the person's stand, limits of
joints are kept, and the summary says what the robot could not do and where.

A map is <BodyMap forward="1 0 0"> with <Limb name="left leg" first="JOINT" fold="JOINT"
last="JOINT"/> for left and right legs and arms; limbs that it leaves out are not used.

{}Examples
  MMMConverterS2KF retarget walk_mmm.xml --robot g1.urdf
  MMMConverterS2KF retarget walk.c3d --height 1.75 --robot g1.urdf -o g1_walk.xml
  MMMConverterS2KF retarget jump_mmm.xml --robot h1.xml --sole shapes --summary jump.json
  MMMConverterS2KF retarget walk_mmm.xml --robot g1.urdf --export-lafan1 walk.csv --export-rate 50
  MMMConverterS2KF retarget walk_mmm.xml --robot g1.urdf --export-beyondmimic w.npz --order isaac
  MMMConverterS2KF retarget --robot g1.urdf --print-map --report g1.html
)";

RetargetRequest MakeRetargetRequest(const Arguments& arguments) {
  RetargetRequest request;
  request.conversion = MakeRequest(task::kRetarget, arguments, arguments.positional().value_or(""));
  request.conversion.output = arguments.Get("output").value_or("");
  if (request.conversion.robot.file.empty()) {
    throw UsageError(
        "retarget: which robot? For instance: MMMConverterS2KF retarget walk_mmm.xml --robot "
        "g1.urdf");
  }
  for (const char* output : {"summary", "report"}) {
    if (const auto file = arguments.Get(output)) request.conversion.more_outputs.push_back(*file);
  }
  for (const RobotExporter& format : RobotExporters()) {
    const auto file = arguments.Get(format.option);
    if (!file) continue;
    for (std::string& one : FilesOf(format, *file)) {
      if (one != *file) CheckIsOwn(one, kRobotNamesBegin);
      request.conversion.more_outputs.push_back(std::move(one));
    }
  }
  return request;
}

/// Without a motion.
void ShowMap(RetargetRequest request, const std::optional<std::string>& page) {
  Warnings warnings;
  const std::string map = DescribeRobotMap(request.conversion.robot, &warnings);
  if (page) {
    request.conversion.output.clear();
    request.conversion.more_outputs = {*page};
    WriteFileAtomically(*page, FormatRetargetPage(RunRetargeting(request, {})));
  }
  LogWarnings(warnings);
  std::cout << map;
}

}  // namespace

Manual RetargetManual() {
  return {kRetargetUsage, CommandOptions(task::kRetarget, RetargetOptions())};
}

int RunRetarget(const Arguments& arguments) {
  StartLog(arguments.Get("log").value_or("info"));
  const RetargetRequest request = MakeRetargetRequest(arguments);
  const RobotRequest& robot = request.conversion.robot;
  const std::vector<RobotExport> exports = ExportsOf(arguments, robot);
  if (!arguments.positional()) {
    const auto page = arguments.Get("report");
    if (!arguments.Has("print-map") && !page) {
      throw UsageError(
          "retarget: which motion? For instance: MMMConverterS2KF retarget walk_mmm.xml --robot "
          "g1.urdf");
    }
    for (const char* idle : {"output", "summary"}) {
      if (arguments.Has(idle)) {
        throw UsageError(fmt::format("retarget: --{} is of a motion; which?", idle));
      }
    }
    if (!exports.empty()) {
      throw UsageError(
          fmt::format("retarget: --{} is of a motion; which?", exports.front().format->option));
    }
    ShowMap(request, page);
    return 0;
  }
  ProgressBar bar("frames");
  RetargetReport report = RunRetargeting(request, [&](int done, int all) {
    bar.Show(done, all);
    return true;
  });
  bar.Clear();
  for (const RobotExport& one : exports) CheckRobotExport(*one.format, robot, report);
  FilesTogether files;
  WriteRobotMotion(&report);
  for (const RobotExport& one : exports) WriteRobotExport(*one.format, one.file, robot, &report);
  LogWarnings(report.warnings);
  if (const auto file = arguments.Get("summary")) {
    WriteFileAtomically(*file, FormatJson(ToJson(report)));
  }
  if (const auto file = arguments.Get("report")) {
    WriteFileAtomically(*file, FormatRetargetPage(report));
  }
  files.Commit();
  if (arguments.Has("print-map")) {
    std::cout << FormatBodyMap(report.robot.model, report.body.map);
  }
  std::cout << FormatRetargetSummary(report);
  std::vector<Verdict::Level> verdicts = {report.verdict.level};
  if (report.conversion_verdict) verdicts.push_back(report.conversion_verdict->level);
  return ExitCodeOf(arguments, verdicts);
}

}  // namespace mmm_converter
