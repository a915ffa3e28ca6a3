// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/commands/request_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace mmm_converter {
namespace {

constexpr Medium kLine = Medium::kCommandLine;

const OptionGroup kGeneral = {
    "General",
    {{"log", "LEVEL", "off, error, warning, info or debug; default: info", ""},
     {"help,h", "", "print this help", ""}}};

bool IsOf(const Option& option, Task task) {
  return *option.names.line != 0 && (option.tasks & task) != 0;
}

void AddGroup(const OptionGroup& group, std::vector<OptionGroup>* groups) {
  const auto same = std::find_if(groups->begin(), groups->end(),
                                 [&](const OptionGroup& one) { return one.title == group.title; });
  if (same == groups->end()) {
    groups->push_back(group);
  } else {
    same->options.insert(same->options.end(), group.options.begin(), group.options.end());
  }
}

}  // namespace

std::vector<OptionGroup> GroupsOf(const std::vector<Option>& table, Task task) {
  std::vector<OptionGroup> groups;
  for (const Option& option : table) {
    if (!IsOf(option, task)) continue;
    AddGroup(
        {option.group,
         {{option.names.line, option.value.kind == OptionKind::kSwitch ? "" : option.value.argument,
           HelpOf(kLine, option, task), option.notes.alias, IsList(option)}}},
        &groups);
  }
  return groups;
}

OptionGroup ExportGroup(const std::string& title, const std::vector<Exporter>& exporters) {
  OptionGroup group = {title, {}};
  for (const Exporter& one : exporters) group.options.push_back({one.option, "FILE", one.help, ""});
  return group;
}

ExportFiles ExportsOf(const Arguments& arguments) {
  ExportFiles files;
  for (const Exporter& exporter : Exporters()) {
    if (const auto file = arguments.Get(exporter.option)) files[exporter.name] = *file;
  }
  return files;
}

std::vector<OptionGroup> CommandOptions(Task task, std::vector<OptionGroup> own,
                                        const std::vector<OptionGroup>& last,
                                        const std::vector<std::string>& per_recording) {
  for (const OptionGroup& group : GroupsOf(DescribedOptions(), task)) AddGroup(group, &own);
  for (const OptionGroup& group : last) AddGroup(group, &own);
  AddGroup(kGeneral, &own);
  for (OptionGroup& group : own) {
    for (OptionSpec& option : group.options) {
      option.repeatable |= std::count(per_recording.begin(), per_recording.end(), option.name) > 0;
    }
  }
  return own;
}

void ReadArguments(const Arguments& arguments, const std::vector<Option>& table, Task task) {
  for (const Option& option : table) {
    const std::string name = LongName(option);
    if (!IsOf(option, task) || !arguments.Has(name)) continue;
    std::vector<std::string> values = arguments.GetAll(name);
    if (option.value.kind == OptionKind::kSwitch) values = {"true"};
    const std::string expected = SetOption(option, values);
    if (expected.empty()) continue;
    throw UsageError(fmt::format("--{}: \"{}\" is not allowed; {}", name, values.back(), expected));
  }
}

ConversionRequest MakeRequest(Task task, const Arguments& arguments, const std::string& file) {
  ConversionRequest request;
  request.input.file = file;
  ReadArguments(arguments, Options(&request), task);
  const std::string contradiction = Contradiction(request);
  if (contradiction.empty() || task == task::kLabel) return request;
  throw UsageError(contradiction);
}

int ExitCodeOf(const Arguments& arguments, const std::vector<Verdict::Level>& verdicts) {
  constexpr int kJudgedFailed = 3;
  const auto failed = std::count(verdicts.begin(), verdicts.end(), Verdict::Level::kFailed);
  return arguments.Has("strict") && failed > 0 ? kJudgedFailed : 0;
}

std::vector<InputRequest> MakeInputs(Task task, const Arguments& arguments,
                                     const std::vector<std::string>& per_recording) {
  std::vector<InputRequest> inputs;
  const std::vector<std::string>& files = arguments.positionals();
  inputs.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Arguments own = arguments.ForPositional(static_cast<int>(i), per_recording);
    inputs.push_back(MakeRequest(task, own, files[i]).input);
  }
  return inputs;
}

}  // namespace mmm_converter
