// SPDX-License-Identifier: MIT
#include "common/pipeline/option.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

bool IsOneOf(const std::vector<std::string>& choices, const std::string& text) {
  return std::find(choices.begin(), choices.end(), text) != choices.end();
}

std::string ExpectedNumber(const Option& option, double unit) {
  std::string text = option.value.kind == OptionKind::kWhole ? "give a whole number" : "give ";
  if (option.value.kind == OptionKind::kNumber) {
    text += *option.value.unit == 0 ? "a number"
                                    : (unit == 1 ? "" : "milli") + std::string(option.value.unit);
  }
  if (std::isfinite(option.value.least))
    text += fmt::format(" from {:.10g}", option.value.least / unit);
  if (std::isfinite(option.value.most))
    text += fmt::format(" to {:.10g}", option.value.most / unit);
  return text;
}

std::string Expected(const Option& option, double unit) {
  switch (option.value.kind) {
    case OptionKind::kSwitch:
      return "use " + JoinNames(Choices(Medium::kManifest, option));
    case OptionKind::kNumber:
    case OptionKind::kWhole:
      return ExpectedNumber(option, unit);
    case OptionKind::kChoice:
      return "use " + JoinNames(Split(option.value.argument, '|'));
    case OptionKind::kFrames:
      return "use A:B, frames A to B-1 counted from 0; for instance 100:400, 100: or :400";
    case OptionKind::kAxis:
      return "use x, y, z, -x, -y or -z";
    default:
      return "give something else";
  }
}

// Sets what an option goes to; false where the value is not what is expected.
struct OptionReading {
  const Option& option;
  const std::vector<std::string>& values;
  double unit;

  const std::string& text() const { return values.back(); }

  bool operator()(std::monostate /*nowhere*/) const { return true; }
  bool operator()(bool* to) const {
    *to = text() == "true";
    return *to || text() == "false";
  }
  template <typename Number>
  bool operator()(Number* to) const {
    const auto number = ParseDouble(text());
    const double value = number.value_or(0) * unit;
    const bool is_whole = option.value.kind != OptionKind::kWhole || ParseLong(text());
    const bool is_allowed = number && std::isfinite(value) && is_whole &&
                            value >= option.value.least && value <= option.value.most;
    if (is_allowed) *to = static_cast<Number>(value);
    return is_allowed;
  }
  bool operator()(std::string* to) const {
    *to = text();
    return option.value.kind != OptionKind::kChoice ||
           IsOneOf(Split(option.value.argument, '|'), text());
  }
  bool operator()(std::optional<std::string>* to) const { return operator()(&to->emplace()); }
  bool operator()(std::vector<std::string>* to) const {
    *to = values;
    return true;
  }
  bool operator()(const std::function<bool(const std::string&)>& to) const { return to(text()); }
};

}  // namespace

Option Row(OptionNames names, OptionValue value, const char* help, const char* otherwise,
           Task tasks, OptionTarget to, OptionNotes notes, const char* group) {
  return {names, value, help, otherwise, tasks, std::move(to), notes, group};
}

bool IsList(const Option& option) {
  return std::holds_alternative<std::vector<std::string>*>(option.to);
}

std::string LongName(const Option& option) {
  const std::string name = option.names.line;
  return name.substr(0, name.find(','));
}

std::string NameIn(Medium medium, const Option& option) {
  if (medium == Medium::kManifest && *option.names.attribute != 0) return option.names.attribute;
  if (medium == Medium::kPython && *option.names.keyword != 0) return option.names.keyword;
  return (medium == Medium::kCommandLine ? "--" : "") + LongName(option);
}

std::string Spell(Medium medium, const std::string& text, const std::vector<Option>& table) {
  std::string spelt = text;
  for (const Option& option : table) {
    const std::string place = "{" + LongName(option) + "}";
    const std::string name = NameIn(medium, option);
    for (std::size_t at = 0; (at = spelt.find(place, at)) != std::string::npos;) {
      spelt.replace(at, place.size(), name);
    }
  }
  return spelt;
}

double UnitOfAttribute(const Option& option) {
  return std::string_view(option.names.attribute).ends_with("_mm") ? 1e-3 : 1;
}

std::vector<std::string> Choices(Medium medium, const Option& option) {
  if (option.value.kind == OptionKind::kChoice) return Split(option.value.argument, '|');
  if (option.value.kind != OptionKind::kSwitch || medium != Medium::kManifest) return {};
  return Split(*option.value.argument == 0 ? "true|false" : option.value.argument, '|');
}

std::string SetOption(const Option& option, const std::vector<std::string>& values, double unit) {
  return std::visit(OptionReading{option, values, unit}, option.to) ? "" : Expected(option, unit);
}

}  // namespace mmm_converter
