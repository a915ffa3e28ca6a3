// SPDX-License-Identifier: MIT
#include "common/convert/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/support/suggestion.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

std::string DescribeRange(const char* kind, double minimum, double maximum) {
  if (std::isfinite(minimum) && std::isfinite(maximum)) {
    return fmt::format("{} from {:.12g} to {:.12g}", kind, minimum, maximum);
  }
  if (std::isfinite(minimum)) return fmt::format("{} of at least {:.12g}", kind, minimum);
  if (std::isfinite(maximum)) return fmt::format("{} of at most {:.12g}", kind, maximum);
  return kind;
}

Setting MakeSetting(const std::string& element, const std::string& attribute,
                    const std::string& documentation) {
  Setting setting;
  setting.element = element;
  setting.attribute = attribute;
  setting.documentation = documentation;
  return setting;
}

std::string DidYouMean(const std::string& name, const std::vector<std::string>& names) {
  const std::string closest = ClosestName(name, names);
  return closest.empty() ? "" : fmt::format(" (did you mean {}?)", closest);
}

// Breaks lines at blanks; every line but the first gets the margin, the rest of a broken one two
// more.
std::string Wrap(const std::string& text, const std::string& margin) {
  constexpr std::size_t kColumns = 100;
  std::string wrapped;
  std::size_t column = margin.size();
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    if (column + end - begin > kColumns && !wrapped.empty() && wrapped.back() == ' ' &&
        column > margin.size()) {
      wrapped.back() = '\n';
      wrapped += margin + "  ";
      column = margin.size() + 2;
    }
    wrapped += text.substr(begin, end - begin);
    column += end - begin + 1;
    if (end < text.size()) wrapped += text[end] == ' ' ? " " : "\n" + margin;
    if (end < text.size() && text[end] == '\n') column = margin.size();
    begin = end + 1;
  }
  return wrapped;
}

}  // namespace

void SettingTable::AddElement(const std::string& element, const std::string& documentation) {
  for (auto& [name, text] : elements_) {
    if (name == element) {
      text = documentation;
      return;
    }
  }
  elements_.emplace_back(element, documentation);
}

void SettingTable::Add(const std::string& element, const std::string& attribute, double* value,
                       double si_factor, double minimum, double maximum,
                       const std::string& documentation) {
  Setting setting = MakeSetting(element, attribute, documentation);
  setting.minimum = minimum;
  setting.maximum = maximum;
  setting.allowed = DescribeRange("a number", minimum, maximum);
  // 12 digits: more would show the rounding of the conversion to SI.
  setting.text = [value, si_factor] { return fmt::format("{:.12g}", *value / si_factor); };
  setting.set = [value, si_factor, minimum, maximum](const std::string& text) {
    const auto number = ParseDouble(text);
    if (!number || !std::isfinite(*number) || *number < minimum || *number > maximum) return false;
    *value = *number * si_factor;
    return true;
  };
  AddSetting(std::move(setting));
}

void SettingTable::Add(const std::string& element, const std::string& attribute, int* value,
                       int minimum, int maximum, const std::string& documentation) {
  Setting setting = MakeSetting(element, attribute, documentation);
  setting.minimum = minimum;
  setting.maximum = maximum;
  setting.is_integer = true;
  setting.allowed = DescribeRange("a whole number", minimum, maximum);
  setting.text = [value] { return std::to_string(*value); };
  setting.set = [value, minimum, maximum](const std::string& text) {
    const auto number = ParseLong(text);
    if (!number || *number < minimum || *number > maximum) return false;
    *value = static_cast<int>(*number);
    return true;
  };
  AddSetting(std::move(setting));
}

void SettingTable::Add(const std::string& element, const std::string& attribute, bool* value,
                       const std::string& documentation) {
  AddChoice<bool>(element, attribute, value, {{"true", true}, {"false", false}}, documentation);
}

void SettingTable::AddNames(Setting setting, const std::vector<std::string>& names,
                            std::function<int()> get, std::function<void(int)> set) {
  setting.allowed = JoinNames(names);
  setting.choices = names;
  setting.text = [names, get = std::move(get)] { return names[get()]; };
  setting.set = [names, set = std::move(set)](const std::string& text) {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) return false;
    set(static_cast<int>(found - names.begin()));
    return true;
  };
  AddSetting(std::move(setting));
}

void SettingTable::AddSetting(Setting setting) {
  const auto known = [&](const auto& element) { return element.first == setting.element; };
  if (std::none_of(elements_.begin(), elements_.end(), known)) {
    elements_.emplace_back(setting.element, "");
  }
  settings_.push_back(std::move(setting));
}

void SettingTable::Read(const std::vector<XmlElement>& elements, Diagnostics* diagnostics) const {
  std::vector<std::string> names;
  for (const auto& [name, unused] : elements_) names.push_back(name);
  std::map<std::string, int> first_lines;
  for (const XmlElement& element : elements) {
    if (std::find(names.begin(), names.end(), element.name) == names.end()) {
      diagnostics->AddError(element.line,
                            fmt::format("unknown element <{}>{}; use {}", element.name,
                                        DidYouMean(element.name, names), JoinNames(names)));
      continue;
    }
    const auto [first, is_new] = first_lines.emplace(element.name, element.line);
    if (!is_new) {
      diagnostics->AddError(
          element.line,
          fmt::format("<{}> is already in line {}; keep one of them", element.name, first->second));
    }
    ReadElement(element, diagnostics);
  }
}

void SettingTable::ReadElement(const XmlElement& element, Diagnostics* diagnostics) const {
  std::vector<std::string> names;
  for (const Setting& setting : settings_) {
    if (setting.element == element.name) names.push_back(setting.attribute);
  }
  for (const auto& [attribute, value] : element.attributes) {
    const auto is_this = [&, &attribute = attribute](const Setting& setting) {
      return setting.element == element.name && setting.attribute == attribute;
    };
    const auto setting = std::find_if(settings_.begin(), settings_.end(), is_this);
    if (setting == settings_.end()) {
      diagnostics->AddError(
          element.line, fmt::format("<{}>: unknown attribute {}{}; use {}", element.name, attribute,
                                    DidYouMean(attribute, names), JoinNames(names)));
    } else if (!setting->set(value)) {
      diagnostics->AddError(element.line,
                            fmt::format("<{}>: {}=\"{}\" is not allowed; use {}", element.name,
                                        attribute, value, setting->allowed));
    }
  }
  for (const XmlElement& child : element.children) {
    diagnostics->AddError(child.line,
                          fmt::format("<{}> can't be inside <{}>, which has only "
                                      "attributes: {}",
                                      child.name, element.name, JoinNames(names, " and ")));
  }
  if (!element.text.empty()) {
    diagnostics->AddError(element.line,
                          fmt::format("text \"{}\" can't be inside <{}>, which has "
                                      "only attributes: {}",
                                      element.text, element.name, JoinNames(names, " and ")));
  }
}

std::string SettingTable::ToXml(int indent) const {
  const std::string margin(indent, ' ');
  const std::string comment_margin = margin + "     ";
  std::string xml;
  for (const auto& [element, documentation] : elements_) {
    std::string comment = documentation;
    std::string attributes;
    for (const Setting& setting : settings_) {
      if (setting.element != element) continue;
      comment +=
          fmt::format("\n{}: {} ({})", setting.attribute, setting.documentation, setting.allowed);
      attributes += fmt::format("\n{}    {}=\"{}\"", margin, setting.attribute, setting.text());
    }
    xml += fmt::format("{}<!-- {} -->\n{}<{}{}/>\n", margin, Wrap(comment, comment_margin), margin,
                       element, attributes);
  }
  return xml;
}

}  // namespace mmm_converter
