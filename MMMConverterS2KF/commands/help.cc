// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/completion.h"
#include "MMMConverterS2KF/terminal/man_page.h"
#include "common/support/suggestion.h"

namespace mmm_converter {
namespace {

constexpr const char* kProgram = "MMMConverterS2KF";

const std::vector<OptionGroup> kHelpOptions = {
    {"Options",
     {{"man", "", "print the manual page as roff, for man -l -", ""},
      {"completion", "", "print the completion for bash", ""},
      {"list", "KIND",
       "print names, one a line: commands, configurations, converters, marker-sets, templates (of "
       "print-config) or kinds",
       ""},
      {"help,h", "", "print this help", ""}}}};

constexpr const char* kHelpUsage = R"(MMMConverterS2KF help [COMMAND] [options]
Prints the help of the program or of a command.

{}Examples
  MMMConverterS2KF help convert
  MMMConverterS2KF help convert --man | man -l -
  source <(MMMConverterS2KF help --completion)
)";

const Command& FindCommand(const std::string& name) {
  const std::vector<Command>& commands = Commands();
  const auto found = std::find_if(commands.begin(), commands.end(),
                                  [&](const Command& command) { return command.name == name; });
  if (found != commands.end()) return *found;
  const std::string closest = ClosestName(name, NamesOfKind("commands"));
  throw UsageError(fmt::format("help: unknown command \"{}\"{}; see MMMConverterS2KF --help", name,
                               closest.empty() ? "" : " (did you mean " + closest + "?)"));
}

std::string PageName(const Command& command) {
  return fmt::format("{}-{}", kProgram, command.name);
}

std::string ProgramManPage() {
  ManPageTitle title = {kProgram, "motion capture markers to MMM motions", {}};
  for (const Command& command : Commands()) title.see_also.push_back(PageName(command));
  const std::string text = ProgramText();
  return FormatManPage(title,
                       {"MMMConverterS2KF COMMAND [arguments]" + text.substr(text.find('\n')), {}});
}

}  // namespace

Manual HelpManual() { return {kHelpUsage, kHelpOptions}; }

int RunHelp(const Arguments& arguments) {
  const auto name = arguments.positional();
  const Command* command = name ? &FindCommand(*name) : nullptr;
  if (arguments.Has("completion")) {
    std::cout << FormatBashCompletion(Commands());
  } else if (arguments.Has("list")) {
    const std::string kind = arguments.GetChoice("list", KindsOfNames(), "");
    for (const std::string& listed : NamesOfKind(kind)) std::cout << listed << '\n';
  } else if (arguments.Has("man")) {
    std::cout << (command ? FormatManPage({PageName(*command), command->summary, {kProgram}},
                                          command->manual())
                          : ProgramManPage());
  } else {
    std::cout << (command ? FormatHelp(command->manual()) : ProgramText());
  }
  return 0;
}

}  // namespace mmm_converter
