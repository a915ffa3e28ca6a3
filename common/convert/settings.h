// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/support/diagnostics.h"

namespace mmm_converter {

/// One attribute of a configuration element, bound to the C++ value that it sets.
struct Setting {
  std::string element;
  std::string attribute;  ///< names its unit, e.g. markerStandardDeviation_mm
  std::string documentation;
  std::string allowed;               ///< for messages: "a number from 0 to 1000"
  std::vector<std::string> choices;  ///< allowed texts; empty for numbers
  double minimum = 0;                ///< numbers: allowed range, in the unit of the attribute
  double maximum = 0;
  bool is_integer = false;
  std::function<std::string()> text;                  ///< the bound value, as an attribute
  std::function<bool(const std::string& value)> set;  ///< false: not allowed, nothing changed
};

/// What a converter can be told: each setting is bound once, and from this table come the reader,
/// the documented template and the listing that tests hold against the XSD. The bound values must
/// outlive the table.
class SettingTable {
 public:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  /// Describes an element in the template; elements appear in the order in which they are first
  /// named.
  void AddElement(const std::string& element, const std::string& documentation);

  /// value = si_factor * attribute; minimum and maximum (both allowed) in the unit of the
  /// attribute.
  void Add(const std::string& element, const std::string& attribute, double* value,
           double si_factor, double minimum, double maximum, const std::string& documentation);
  void Add(const std::string& element, const std::string& attribute, int* value, int minimum,
           int maximum, const std::string& documentation);
  /// "true" or "false".
  void Add(const std::string& element, const std::string& attribute, bool* value,
           const std::string& documentation);
  /// One of some names, e.g. {{"s2kf", FilterType::kS2kf}, {"ekf", FilterType::kEkf}}.
  template <typename Enum>
  void AddChoice(const std::string& element, const std::string& attribute, Enum* value,
                 std::vector<std::pair<std::string, Enum>> names, const std::string& documentation);

  /// Sets the bound values from elements; what an element does not say keeps its value. Reports
  /// every unknown, repeated or misplaced element, unknown attribute and value that is not allowed,
  /// with its line and what is allowed.
  void Read(const std::vector<XmlElement>& elements, Diagnostics* diagnostics) const;

  /// All elements with the bound values and their documentation as XML comments.
  /// indent: blanks before each line.
  std::string ToXml(int indent) const;

  const std::vector<Setting>& settings() const { return settings_; }
  /// Names and documentation, in the order of the template.
  const std::vector<std::pair<std::string, std::string>>& elements() const { return elements_; }

 private:
  void AddSetting(Setting setting);
  void AddNames(Setting setting, const std::vector<std::string>& names, std::function<int()> get,
                std::function<void(int)> set);
  void ReadElement(const XmlElement& element, Diagnostics* diagnostics) const;

  std::vector<std::pair<std::string, std::string>> elements_;
  std::vector<Setting> settings_;
};

template <typename Enum>
void SettingTable::AddChoice(const std::string& element, const std::string& attribute, Enum* value,
                             std::vector<std::pair<std::string, Enum>> names,
                             const std::string& documentation) {
  Setting setting;
  setting.element = element;
  setting.attribute = attribute;
  setting.documentation = documentation;
  std::vector<std::string> texts;
  texts.reserve(names.size());
  for (const auto& [text, unused] : names) texts.push_back(text);
  const auto get = [value, names] {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].second == *value) return static_cast<int>(i);
    }
    return 0;
  };
  const auto set = [value, names](int index) { *value = names[index].second; };
  AddNames(std::move(setting), texts, get, set);
}

}  // namespace mmm_converter
