// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/support/text.h"

namespace mmm_converter {

using Eigen::Vector3d;

namespace {

// Of SI units: no body has more, and squares of it are numbers.
constexpr double kMostOfNumbers = 1e9;

}  // namespace

std::string OsimName(const XmlElement& object) {
  const std::string* name = object.FindAttribute("name");
  return name == nullptr ? "" : std::string(Trim(*name));
}

std::string_view OsimText(const XmlElement& object, std::string_view property) {
  const XmlElement* element = object.FindChild(property);
  return element == nullptr ? std::string_view() : std::string_view(element->text);
}

std::vector<std::string> Words(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\f\v";
  std::vector<std::string> words;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::vector<double> ReadOsimNumbers(const XmlElement& object, std::string_view property,
                                    std::size_t count, const std::vector<double>& otherwise,
                                    Diagnostics* diagnostics) {
  const XmlElement* element = object.FindChild(property);
  if (element == nullptr || element->text.empty()) return otherwise;
  std::vector<double> numbers;
  const bool are_numbers = AppendDoubles(element->text, &numbers) &&
                           std::all_of(numbers.begin(), numbers.end(),
                                       [](double x) { return std::abs(x) <= kMostOfNumbers; });
  if (are_numbers && (count == 0 || numbers.size() == count)) return numbers;
  diagnostics->AddError(element->line,
                        fmt::format("<{}>: \"{:.60}\" is not {}", element->name, element->text,
                                    count == 0   ? std::string("a list of finite numbers")
                                    : count == 1 ? std::string("a finite number")
                                                 : fmt::format("{} finite numbers", count)));
  return otherwise;
}

double ReadOsimNumber(const XmlElement& object, std::string_view property, double otherwise,
                      Diagnostics* diagnostics) {
  return ReadOsimNumbers(object, property, 1, {otherwise}, diagnostics).front();
}

bool ReadOsimFlag(const XmlElement& object, std::string_view property, bool otherwise,
                  Diagnostics* diagnostics) {
  const XmlElement* element = object.FindChild(property);
  if (element == nullptr || element->text.empty()) return otherwise;
  if (EqualIgnoringCase(element->text, "true") || element->text == "1") return true;
  if (EqualIgnoringCase(element->text, "false") || element->text == "0") return false;
  diagnostics->AddError(element->line, fmt::format("<{}>: \"{:.60}\" is neither true nor false",
                                                   element->name, element->text));
  return otherwise;
}

Vector3d ReadOsimVector(const XmlElement& object, std::string_view property,
                        const Vector3d& otherwise, Diagnostics* diagnostics) {
  const std::vector<double> v = ReadOsimNumbers(
      object, property, 3, {otherwise.x(), otherwise.y(), otherwise.z()}, diagnostics);
  return {v[0], v[1], v[2]};
}

Eigen::Isometry3d ReadOsimPose(const XmlElement& object, std::string_view translation,
                               std::string_view orientation, Diagnostics* diagnostics) {
  const Vector3d turns = ReadOsimVector(object, orientation, Vector3d::Zero(), diagnostics);
  Eigen::Isometry3d X(
      Eigen::Translation3d(ReadOsimVector(object, translation, Vector3d::Zero(), diagnostics)));
  for (int i = 0; i < 3; ++i) X.rotate(Eigen::AngleAxisd(turns[i], Vector3d::Unit(i)));
  return X;
}

const XmlElement* FindOsimObject(const XmlElement& object, std::string_view property) {
  for (const XmlElement& child : object.children) {
    if (child.Is(property)) return child.children.empty() ? nullptr : &child.children.front();
    if (EqualIgnoringCase(OsimName(child), property)) return &child;
  }
  return nullptr;
}

const XmlElement* FindOsimObjects(const XmlElement& owner, std::string_view set) {
  const XmlElement* element = owner.FindChild(set);
  return element == nullptr ? nullptr : element->FindChild("objects");
}

}  // namespace mmm_converter
