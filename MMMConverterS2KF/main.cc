// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/report/version.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "MMMConverterS2KF/terminal/printable.h"
#include "common/math/instruction_set.h"
#include "common/pipeline/conversion_options.h"
#include "common/support/opened_files.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kFailed = 1;
constexpr int kMisused = 2;

int RunCommand(const Command& command, const std::vector<std::string>& words) {
  const Manual manual = command.manual();
  const Arguments arguments =
      ParseArguments(command.name, manual.options, words, manual.several_inputs);
  const OpenedFiles opened;  // which the command must not replace
  if (!arguments.Has("help")) return command.run(arguments);
  std::cout << FormatHelp(manual);
  return 0;
}

int Run(const std::vector<std::string>& words) {
  const std::string first = words.empty() ? "--help" : words.front();
  if (first == "--help" || first == "-h") {
    std::cout << ProgramText();
    return 0;
  }
  if (first == "--version") {
    std::cout << VersionText();
    return 0;
  }
  ActiveInstructionSet();  // an impossible wish ends here, not in the middle of the work
  // A script that calls MMMMotionConverter names no command.
  if (std::find(words.begin(), words.end(), "--inputMotion") != words.end() && first[0] == '-') {
    return RunCommand(Commands().front(), words);
  }
  std::vector<std::string> names;
  for (const Command& command : Commands()) {
    if (first == command.name) return RunCommand(command, {words.begin() + 1, words.end()});
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
    SetWording(WordingOf(Medium::kCommandLine));
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

// A file that is opened must not take the place of a stream that the caller has closed: messages
// would be written into it. Of these, nothing can be written to /dev/null either, as before.
void OccupyClosedStreams() {
  int descriptor = 0;
  do {
    descriptor = ::open("/dev/null", O_RDONLY);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor > STDERR_FILENO) ::close(descriptor);
}

constexpr const char* kNoMemory =
    "error: there is not enough memory for this; close other programs, allow this one more "
    "(ulimit -v) or take a part of the recording (--frames A:B)\n";

}  // namespace
}  // namespace mmm_converter

int main(int argc, char** argv) {
  mmm_converter::OccupyClosedStreams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is then an error that is said
  try {
    return mmm_converter::RunAndExplain({argv + 1, argv + argc});
  } catch (const std::bad_alloc&) {  // maybe of saying something else
    std::fputs(mmm_converter::kNoMemory, stderr);
    return mmm_converter::kFailed;
  }
}
