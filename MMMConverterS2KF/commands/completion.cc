// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/commands/completion.h"

#include <fmt/format.h>

#include <functional>
#include <map>

#include "common/convert/plugin_loader.h"
#include "common/support/data_directory.h"
#include "common/support/folder.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

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

const std::map<std::string, std::function<std::vector<std::string>()>> kNamesOfKind = {
    {"commands", CommandNames},
    {"configurations", [] { return StemsIn(DataFile("converters"), ".xml"); }},
    {"converters", ConverterNames},
    {"kinds", KindsOfNames},
    {"marker-sets", [] { return StemsIn(DataFile("marker_sets"), ".xml"); }},
    {"templates", TemplateNames}};

}  // namespace

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

std::vector<std::string> NamesOfKind(const std::string& kind) { return kNamesOfKind.at(kind)(); }

}  // namespace mmm_converter
