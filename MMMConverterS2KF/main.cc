// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/terminal/advice.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/printable.h"
#include "MMMConverterS2KF/terminal/version.h"
#include "common/math/instruction_set.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kFailed = 1;
constexpr int kMisused = 2;

constexpr std::array kCommands = {
    Command{"convert", "convert a recording into an MMM motion", RunConvert},
    Command{"batch", "convert many recordings on all cores", RunBatch},
    Command{"calibrate", "estimate segment lengths and marker places of a person", RunCalibrate},
    Command{"check-dynamics", "check whether a body can move like a motion", RunCheckDynamics},
    Command{"compare", "compare converters on recordings", RunCompare},
    Command{"evaluate", "repeat the evaluation of the paper", RunEvaluate},
    Command{"export-poses", "write where the segments of a motion are, as CSV or for NumPy",
            RunExportPoses},
    Command{"export-urdf", "write the model of a person as a URDF", RunExportUrdf},
    Command{"info", "describe a file that this program reads or writes", RunInfo},
    Command{"label", "name the points of a recording, or repair its labels", RunLabel},
    Command{"learn-markers", "learn where a laboratory's labels are worn", RunLearnMarkers},
    Command{"live", "track while a motion capture system streams", RunLive},
    Command{"print-config", "print the configuration of a converter with every setting",
            RunPrintConfig},
    Command{"report", "show finished motions and their recording on a page", RunReport},
    Command{"serve", "play a recording as a motion capture system streams", RunServe}};

constexpr const char* kUsage = R"(MMMConverterS2KF {}: motion capture markers to MMM motions

Commands (each has --help)
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

Exit codes: 0 done, 1 input or conversion failed, 2 the command line is invalid
)";

void PrintHelp() {
  std::string commands;
  for (const Command& command : kCommands) {
    commands += fmt::format("  {:<15} {}\n", command.name, command.summary);
  }
  std::cout << fmt::format(kUsage, MMM_CONVERTER_VERSION, commands);
}

int Run(const std::vector<std::string>& words) {
  const std::string first = words.empty() ? "--help" : words.front();
  if (first == "--help" || first == "-h" || first == "help") {
    PrintHelp();
    return 0;
  }
  if (first == "--version") {
    std::cout << VersionText();
    return 0;
  }
  ActiveInstructionSet();  // an impossible wish ends here, not in the middle of the work
  // A script that calls MMMMotionConverter names no command.
  if (std::find(words.begin(), words.end(), "--inputMotion") != words.end() && first[0] == '-') {
    return RunConvert(words);
  }
  std::vector<std::string> names;
  for (const Command& command : kCommands) {
    if (first == command.name) return command.run({words.begin() + 1, words.end()});
    names.emplace_back(command.name);
  }
  const std::string closest = ClosestName(first, names);
  throw UsageError(fmt::format("unknown command \"{}\"{}; use {}", first,
                               closest.empty() ? "" : " (did you mean " + closest + "?)",
                               JoinNames(names)));
}

std::string Explain(const std::filesystem::filesystem_error& error) {
  std::error_code failure;
  const auto folder = std::filesystem::current_path(failure);
  if (failure) return "the working folder is not there any more; change into another one";
  return fmt::format("{}: can't be reached: {}",
                     error.path1().empty() ? folder.string() : error.path1().string(),
                     error.code().message());
}

// Runs a command and says what was wrong.
int RunAndExplain(const std::vector<std::string>& words) {
  const PrintableOutput output;
  try {
    StartLog("info");
    const int exit_code = Run(words);
    std::cout.flush();
    if (!std::cout) throw Error("can't write to the standard output");
    return exit_code;
  } catch (const UsageError& error) {
    LogError(error.what());
    return kMisused;
  } catch (const Error& error) {
    LogError(WithAdvice(error));
  } catch (const std::filesystem::filesystem_error& error) {
    LogError(Explain(error));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    LogError(fmt::format("unexpected: {}", error.what()));
  }
  return kFailed;
}

constexpr const char* kNoMemory =
    "error: there is not enough memory for this; close other programs, allow this one more "
    "(ulimit -v) or take a part of the recording (--frames A:B)\n";

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is then an error that is said
  try {
    return mmm_converter::RunAndExplain({argv + 1, argv + argc});
  } catch (const std::bad_alloc&) {  // maybe of saying something else
    std::fputs(mmm_converter::kNoMemory, stderr);
    return mmm_converter::kFailed;
  }
}
