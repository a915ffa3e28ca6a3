// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/commands/commands.h"

#include <fmt/format.h>

namespace mmm_converter {
namespace {

constexpr const char* kText = R"(MMMConverterS2KF {}: motion capture markers to MMM motions

Commands (each has --help and a manual page)
{}
Examples
  MMMConverterS2KF info walk.c3d
  MMMConverterS2KF convert walk.c3d --height 1.75 -o walk_mmm.xml
  MMMConverterS2KF print-config S2KFConverter > my.xml

Environment
  MMM_CONVERTER_PLUGIN_PATH  folders of additional converter plugins, separated by colons
  MMM_CONVERTER_DATA         folder of models, marker sets and configurations that replaces the
                             installed one
  MMM_CONVERTER_INSTRUCTION_SET  baseline, avx2 or avx512, instead of the best available

Exit codes
  0  done: outputs are written, whatever the verdict on them
  1  input or conversion failed; of check-dynamics also: the motion is implausible
  2  the command line is invalid
  3  with --strict: outputs are written, and a verdict is failed
)";

}  // namespace

const std::vector<Command>& Commands() {
  static const std::vector<Command> commands = {
      {"convert", "convert a recording into an MMM motion", ConvertManual, RunConvert},
      {"batch", "convert many recordings on all cores", BatchManual, RunBatch},
      {"calibrate", "estimate segment lengths and marker places of a person", CalibrateManual,
       RunCalibrate},
      {"check-dynamics", "check whether a body can move like a motion", CheckDynamicsManual,
       RunCheckDynamics},
      {"compare", "compare converters on recordings", CompareManual, RunCompare},
      {"evaluate", "repeat the evaluation of the paper", EvaluateManual, RunEvaluate},
      {"export-poses", "write where the segments of a motion are, as CSV or for NumPy",
       ExportPosesManual, RunExportPoses},
      {"export-urdf", "write the model of a person as a URDF", ExportUrdfManual, RunExportUrdf},
      {"help", "print help, manual pages or the completion for bash", HelpManual, RunHelp},
      {"info", "describe a file that this program reads or writes", InfoManual, RunInfo},
      {"label", "name the points of a recording, or repair its labels", LabelManual, RunLabel},
      {"learn-markers", "learn where a laboratory's labels are worn", LearnMarkersManual,
       RunLearnMarkers},
      {"live", "track while a motion capture system streams", LiveManual, RunLive},
      {"print-config", "print the configuration of a converter with every setting",
       PrintConfigManual, RunPrintConfig},
      {"report", "show finished motions and their recording on a page", ReportManual, RunReport},
      {"retarget", "bring a motion to a humanoid robot", RetargetManual, RunRetarget},
      {"serve", "play a recording as a motion capture system streams", ServeManual, RunServe}};
  return commands;
}

std::string ProgramText() {
  std::string commands;
  for (const Command& command : Commands()) {
    commands += fmt::format("  {:<15} {}\n", command.name, command.summary);
  }
  return fmt::format(kText, MMM_CONVERTER_VERSION, commands);
}

}  // namespace mmm_converter
