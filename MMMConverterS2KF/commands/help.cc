// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/terminal/manual.h"
#include "common/convert/plugin_loader.h"
#include "common/support/data_directory.h"
#include "common/support/folder.h"
#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

struct ManPageTitle {
  std::string name;                   ///< "MMMConverterS2KF-convert"
  std::string summary;                ///< one line
  std::vector<std::string> see_also;  ///< names of other pages of section 1
};

// Lines that stand together, all indented or none.
struct Block {
  std::vector<std::string> lines;
  bool is_indented = false;
  bool after_gap = false;  // an empty line stands before it
  bool is_title = false;   // of the indented lines that follow
};

std::string ToUpper(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

// Text as roff shows it: what has a meaning there is escaped.
std::string Escape(std::string_view text) {
  static const std::map<char, const char*> escapes = {
      {'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}};
  std::string escaped;
  for (const char c : text) {
    const auto found = escapes.find(c);
    found == escapes.end() ? escaped += c : escaped += found->second;
  }
  return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

std::size_t Indentation(const std::string& line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

std::vector<Block> SplitBlocks(const std::string& text) {
  std::vector<Block> blocks;
  bool after_gap = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) {
      after_gap = true;
      continue;
    }
    const bool is_indented = line.front() == ' ';
    if (blocks.empty() || after_gap || is_indented != blocks.back().is_indented) {
      if (is_indented && !after_gap && !blocks.empty()) {
        blocks.back().is_title = blocks.back().after_gap && blocks.back().lines.size() == 1;
      }
      blocks.push_back({{}, is_indented, after_gap});
    }
    blocks.back().lines.push_back(line);
    after_gap = false;
  }
  return blocks;
}

// A list's line: its term ends where two spaces follow.
std::size_t EndOfTerm(const std::string& line) { return line.find("  ", Indentation(line)); }

bool IsList(const Block& block) {
  const std::string first(Trim(block.lines.front()));
  return !first.starts_with("MMMConverterS2KF") &&
         EndOfTerm(block.lines.front()) != std::string::npos;
}

std::string FormatList(const Block& block) {
  const std::size_t indentation = Indentation(block.lines.front());
  std::string page;
  for (const std::string& line : block.lines) {
    if (Indentation(line) > indentation) {
      page += Escape(Trim(line)) + '\n';
      continue;
    }
    const std::size_t end = std::min(EndOfTerm(line), line.size());
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", Escape(Trim(line.substr(0, end))),
                        Escape(Trim(line.substr(end))));
  }
  return page;
}

std::string FormatBlock(const Block& block) {
  if (block.is_title) return fmt::format(".SH {}\n", Escape(ToUpper(block.lines.front())));
  if (block.is_indented && IsList(block)) return FormatList(block);
  std::string page = block.is_indented ? ".PP\n.EX\n" : ".PP\n";
  for (const std::string& line : block.lines) page += Escape(Trim(line)) + '\n';
  return block.is_indented ? page + ".EE\n" : page;
}

std::string FormatBlocks(const std::vector<Block>& blocks) {
  std::string page;
  for (const Block& block : blocks) page += FormatBlock(block);
  return page;
}

std::string FormatOption(const OptionSpec& option) {
  std::vector<std::string> names;
  for (const std::string& name : NamesOf(option)) names.push_back("\\fB" + Escape(name) + "\\fR");
  std::string page = ".TP\n" + JoinNames(names, ", ");
  if (!option.argument.empty()) page += " \\fI" + Escape(option.argument) + "\\fR";
  page += '\n' + Escape(option.help);
  if (!option.alias.empty()) page += "; also \\fB" + Escape("--" + option.alias) + "\\fR";
  return page + '\n';
}

std::string FormatOptionSections(const std::vector<OptionGroup>& groups) {
  std::string page = ".SH OPTIONS\n";
  for (const OptionGroup& group : groups) {
    if (group.title.empty()) continue;
    page += fmt::format(".SS {}\n", Escape(group.title));
    for (const OptionSpec& option : group.options) page += FormatOption(option);
  }
  return page;
}

/// A page of section 1 for man: roff with the macros of man(7), in UTF-8.
std::string FormatManPage(const ManPageTitle& title, const Manual& manual) {
  const std::size_t begin = std::min(manual.text.find('\n'), manual.text.size());
  const std::size_t place = manual.text.find(kPlaceOfOptions);
  std::string page = fmt::format(
      ".TH {} 1 \"\" \"MMMConverterS2KF " MMM_CONVERTER_VERSION
      "\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n\\fB{}\\fR\n.SH DESCRIPTION\n",
      Escape(title.name), Escape(title.name), Escape(title.summary),
      Escape(manual.text.substr(0, begin)));
  page += FormatBlocks(SplitBlocks(manual.text.substr(begin + 1, place - begin - 1)));
  if (place != std::string::npos) {
    page += FormatOptionSections(manual.options);
    const auto rest = SplitBlocks('\n' + manual.text.substr(place + 2));
    if (!rest.empty() && !rest.front().is_title) page += ".SH NOTES\n";
    page += FormatBlocks(rest);
  }
  page += ".SH SEE ALSO\n.nh\n";
  std::vector<std::string> pages;
  for (const std::string& name : title.see_also) pages.push_back("\\fB" + Escape(name) + "\\fR(1)");
  return page + JoinNames(pages, ", ") + '\n';
}

// What an option's argument of this name takes: these words, else what a function of the script
// offers.
const std::map<std::string, std::string> kWordsOfArgument = {
    {"LEVEL", "off error warning info debug"}, {"AXIS", "x y z -x -y -z"}};
const std::map<std::string, std::string> kKindOfArgument = {
    {"FILE", "files"}, {"RECORDING", "files"}, {"FOLDER", "folders"}, {"DIR", "folders"}};

// Options that take the name of something that is installed; most take a file, too.
const std::map<std::string, std::string> kKindOfOption = {{"config", "configurations"},
                                                          {"marker-set", "marker-sets"},
                                                          {"converter", "converters"},
                                                          {"list", "kinds"}};

// Commands whose inputs are no files.
const std::map<std::string, std::string> kKindOfInput = {{"help", "commands"},
                                                         {"print-config", "templates"}};

constexpr const char* kScript =
    R"(# bash completion of MMMConverterS2KF, printed by "MMMConverterS2KF help --completion"

_MMMConverterS2KF() {{
  local program=$1 word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
  local IFS=$' \t\n' options= words= kind=files
  COMPREPLY=()
  # "--option=value" comes as three words.
  if [[ $word == = ]]; then
    word=
  elif [[ $before == = ]]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '{}' -- "$word")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ -n $options && $word == -* ]]; then
    words=$options
    kind=
  fi
  case $kind in
    '' | files | folders) ;;
    *) words=$("$program" help --list "$kind" 2>/dev/null) ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  case $kind in
    files | configurations | marker-sets)
      mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -- "$word")
      compopt -o filenames 2>/dev/null ;;
    folders)
      mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -d -- "$word")
      compopt -o filenames 2>/dev/null ;;
  esac
}}

complete -F _MMMConverterS2KF MMMConverterS2KF
)";

std::string Find(const std::map<std::string, std::string>& table, const std::string& key) {
  const auto found = table.find(key);
  return found == table.end() ? "" : found->second;
}

std::string LongName(const OptionSpec& option) { return NamesOf(option).front().substr(2); }

// The branch of the script for the value of an option.
std::string FormatValue(const OptionSpec& option) {
  std::vector<std::string> names = NamesOf(option);
  if (!option.alias.empty()) names.push_back("--" + option.alias);
  std::string words = Find(kWordsOfArgument, option.argument);
  if (option.argument.find('|') != std::string::npos) {
    words = option.argument;
    std::replace(words.begin(), words.end(), '|', ' ');
  }
  std::string kind = Find(kKindOfOption, LongName(option));
  if (kind.empty()) kind = Find(kKindOfArgument, option.argument);
  return fmt::format("        {}) {}kind={} ;;\n", fmt::join(names, " | "),
                     words.empty() ? "" : fmt::format("words='{}' ", words), kind);
}

// The branch of the script for a command.
std::string FormatCommand(const Command& command) {
  std::string values;
  std::string options;
  for (const OptionGroup& group : command.manual().options) {
    for (const OptionSpec& option : group.options) {
      if (!option.argument.empty()) values += FormatValue(option);
      if (!group.title.empty()) options += NamesOf(option).front() + " ";
    }
  }
  options.pop_back();
  const std::string kind = Find(kKindOfInput, command.name);
  return fmt::format(
      "    {})\n      case $before in\n{}        *) options='{}'{} ;;\n      esac ;;\n",
      command.name, values, options, kind.empty() ? "" : " kind=" + kind);
}

std::vector<std::string> CommandNames() {
  std::vector<std::string> names;
  for (const Command& command : Commands()) names.emplace_back(command.name);
  return names;
}

std::vector<std::string> ConverterNames() {
  std::vector<std::string> names;
  for (const FoundPlugin& plugin : FindPlugins()) {
    if (!plugin.name.empty()) names.push_back(plugin.name);
  }
  return names;
}

std::vector<std::string> TemplateNames() {
  std::vector<std::string> names = ConverterNames();
  names.insert(names.end(), {"batch", "batch-schema"});
  return names;
}

/// What NamesOfKind knows.
std::vector<std::string> KindsOfNames();

const std::map<std::string, std::function<std::vector<std::string>()>> kNamesOfKind = {
    {"commands", CommandNames},
    {"configurations", [] { return StemsIn(DataFile("converters"), ".xml"); }},
    {"converters", ConverterNames},
    {"kinds", KindsOfNames},
    {"marker-sets", [] { return StemsIn(DataFile("marker_sets"), ".xml"); }},
    {"templates", TemplateNames}};

/// A script for bash that completes the commands, their options and what these take. Names that
/// depend on the installation are asked of the program when they are needed (NamesOfKind).
std::string FormatBashCompletion(const std::vector<Command>& commands) {
  std::string names;
  std::string branches;
  for (const Command& command : commands) {
    names += std::string(command.name) + " ";
    branches += FormatCommand(command);
  }
  return fmt::format(kScript, names + "--help --version", branches);
}

std::vector<std::string> KindsOfNames() {
  std::vector<std::string> kinds;
  kinds.reserve(kNamesOfKind.size());
  for (const auto& [kind, names] : kNamesOfKind) kinds.push_back(kind);
  return kinds;
}

/// The commands, or what is installed of a kind, one of KindsOfNames: "configurations" and the
/// like.
std::vector<std::string> NamesOfKind(const std::string& kind) { return kNamesOfKind.at(kind)(); }

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
