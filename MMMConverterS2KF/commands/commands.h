// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/manual.h"

namespace mmm_converter {

/// A sub-command. Results go to stdout, everything else to stderr.
struct Command {
  const char* name;
  const char* summary;  ///< one line
  Manual (*manual)();
  int (*run)(const Arguments& arguments);  ///< Returns the exit code.
};

/// All commands, in the order in which the help names them.
const std::vector<Command>& Commands();

/// The help of the program: its commands, environment and exit codes.
std::string ProgramText();

Manual BatchManual();
Manual CalibrateManual();
Manual CheckDynamicsManual();
Manual CompareManual();
Manual ConvertManual();
Manual EvaluateManual();
Manual ExportPosesManual();
Manual ExportUrdfManual();
Manual HelpManual();
Manual InfoManual();
Manual LabelManual();
Manual LearnMarkersManual();
Manual LiveManual();
Manual PrintConfigManual();
Manual ReportManual();
Manual RetargetManual();
Manual ServeManual();

int RunBatch(const Arguments& arguments);
int RunCalibrate(const Arguments& arguments);
int RunCheckDynamics(const Arguments& arguments);
int RunCompare(const Arguments& arguments);
int RunConvert(const Arguments& arguments);
int RunEvaluate(const Arguments& arguments);
int RunExportPoses(const Arguments& arguments);
int RunExportUrdf(const Arguments& arguments);
int RunHelp(const Arguments& arguments);
int RunInfo(const Arguments& arguments);
int RunLabel(const Arguments& arguments);
int RunLearnMarkers(const Arguments& arguments);
int RunLive(const Arguments& arguments);
int RunPrintConfig(const Arguments& arguments);
int RunReport(const Arguments& arguments);
int RunRetarget(const Arguments& arguments);
int RunServe(const Arguments& arguments);

}  // namespace mmm_converter
