// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/terminal/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>

#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

namespace po = boost::program_options;

constexpr unsigned kLineLength = 100;
constexpr std::string_view kNames[] = {"FILE", "FOLDER", "DIR", "RECORDING"};  // of arguments

std::string LongName(const OptionSpec& option) {
  return option.name.substr(0, option.name.find(','));
}

void AddOption(po::options_description* description, const std::string& name,
               const OptionSpec& option) {
  if (option.argument.empty()) {
    description->add_options()(name.c_str(), option.help.c_str());
  } else {
    auto* value = po::value<std::string>()->value_name(option.argument);
    description->add_options()(name.c_str(), value, option.help.c_str());
  }
}

po::options_description AllOptions(const std::vector<OptionGroup>& groups) {
  po::options_description all;
  for (const OptionGroup& group : groups) {
    for (const OptionSpec& option : group.options) {
      AddOption(&all, option.name, option);
      if (!option.alias.empty()) AddOption(&all, option.alias, option);
    }
  }
  return all;
}

std::string WithoutDashes(const std::string& word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

UsageError UnknownOption(const std::string& command, const std::string& word,
                         const po::options_description& options) {
  std::vector<std::string> names;
  for (const auto& option : options.options()) names.push_back(option->long_name());
  const std::string closest = ClosestName(WithoutDashes(word), names);
  return UsageError(fmt::format("{}: unknown option {}{}; see MMMConverterS2KF {} --help", command,
                                word, closest.empty() ? "" : " (did you mean --" + closest + "?)",
                                command));
}

po::parsed_options Parse(const std::string& command, const po::options_description& options,
                         const std::vector<std::string>& words) {
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    return po::command_line_parser(words).options(options).style(style).run();
  } catch (const po::unknown_option& error) {
    throw UnknownOption(command, error.get_option_name(), options);
  } catch (const po::error& error) {
    throw UsageError(
        fmt::format("{}: {}; see MMMConverterS2KF {} --help", command, error.what(), command));
  }
}

}  // namespace

std::optional<std::string> Arguments::Get(const std::string& name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) return std::nullopt;
  return found->second.back();
}

std::vector<std::string> Arguments::GetAll(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? std::vector<std::string>() : found->second;
}

Arguments Arguments::ForPositional(int i, const std::vector<std::string>& options) const {
  Arguments one = *this;
  one.positionals_ = {positionals_[i]};
  for (const std::string& option : options) {
    const auto found = one.values_.find(option);
    if (found == one.values_.end() || found->second.size() == 1) continue;
    if (found->second.size() != positionals_.size()) {
      throw UsageError(
          fmt::format("--{} is given {} times for {} files; give it once for all, or once for each "
                      "in their order",
                      option, found->second.size(), positionals_.size()));
    }
    found->second = {found->second[i]};
  }
  return one;
}

std::string Arguments::GetChoice(const std::string& name, const std::vector<std::string>& choices,
                                 const std::string& otherwise) const {
  std::string text = Get(name).value_or(otherwise);
  if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
    throw UsageError(
        fmt::format("--{}: \"{}\" is not allowed; use {}", name, text, JoinNames(choices)));
  }
  return text;
}

std::optional<int> Arguments::GetInteger(const std::string& name, int minimum, int maximum) const {
  const auto text = Get(name);
  if (!text) return std::nullopt;
  const auto number = ParseLong(*text);
  if (!number || *number < minimum || *number > maximum) {
    throw UsageError(fmt::format("--{}: \"{}\" is not allowed; give a whole number from {} to {}",
                                 name, *text, minimum, maximum));
  }
  return static_cast<int>(*number);
}

std::optional<double> Arguments::GetNumber(const std::string& name, const std::string& unit) const {
  const auto text = Get(name);
  if (!text) return std::nullopt;
  const auto number = ParseDouble(*text);
  if (!number || !std::isfinite(*number)) {
    throw UsageError(fmt::format("--{}: \"{}\" is not a number; give {}", name, *text, unit));
  }
  return number;
}

Arguments ParseArguments(const std::string& command, const std::vector<OptionGroup>& groups,
                         const std::vector<std::string>& words, bool several_positionals) {
  std::map<std::string, std::string> long_names;  // also of aliases
  std::set<std::string> repeatable;
  std::set<std::string> files;
  for (const OptionGroup& group : groups) {
    for (const OptionSpec& option : group.options) {
      if (std::count(std::begin(kNames), std::end(kNames), option.argument) > 0) {
        files.insert(LongName(option));
      }
      long_names[LongName(option)] = LongName(option);
      if (option.repeatable) repeatable.insert(LongName(option));
      if (!option.alias.empty()) long_names[option.alias] = LongName(option);
    }
  }
  Arguments arguments;
  const po::parsed_options parsed = Parse(command, AllOptions(groups), words);
  for (const auto& option : parsed.options) {
    const std::string value = option.value.empty() ? "" : option.value.front();
    if (option.position_key >= 0 || option.string_key.empty()) {
      if (!several_positionals && !arguments.positionals_.empty()) {
        throw UsageError(fmt::format("{}: one input only, but there are \"{}\" and \"{}\"", command,
                                     arguments.positionals_.front(), value));
      }
      arguments.positionals_.push_back(value);
      continue;
    }
    const std::string& name = long_names.at(option.string_key);
    if (value.empty() && files.count(name) > 0) {
      throw UsageError(
          fmt::format("{}: --{} names nothing: its value is empty; give a name or leave "
                      "the option out",
                      command, option.string_key));
    }
    std::vector<std::string>& values = arguments.values_[name];
    if (!values.empty() && repeatable.count(name) == 0) {
      throw UsageError(fmt::format("{}: --{} is given twice", command, option.string_key));
    }
    values.push_back(value);
  }
  return arguments;
}

std::string FormatOptions(const std::vector<OptionGroup>& groups) {
  std::ostringstream text;
  for (const OptionGroup& group : groups) {
    if (group.title.empty()) continue;
    po::options_description shown(group.title, kLineLength, kLineLength / 2);
    for (const OptionSpec& option : group.options) AddOption(&shown, option.name, option);
    text << shown << '\n';
  }
  return text.str();
}

}  // namespace mmm_converter
