// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_defaults.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

/// Of those that a robot is made of.
bool HasDefaults(std::string_view element) {
  return element == "joint" || element == "geom" || element == "site" || element == "mesh";
}

}  // namespace

MjcfDefaults::MjcfDefaults(MjcfText* text) : text_(*text) {
  classes_.emplace_back();
  by_name_["main"] = 0;
  for (const XmlElement* element : text_.root().FindChildren("default")) {
    const std::string* name = element->FindAttribute("class");
    if (name != nullptr) by_name_.emplace(*name, 0);  // old files call it as they like
    Read(*element, 0);
  }
}

void MjcfDefaults::Read(const XmlElement& element, int into) {
  for (const XmlElement& child : element.children) {
    if (child.Is("default")) {
      const std::string* name = child.FindAttribute("class");
      if (name == nullptr || name->empty()) {
        text_.Fail(child, "<default> inside another without a class");
        continue;
      }
      const int index = static_cast<int>(classes_.size());
      if (!by_name_.emplace(*name, index).second) {
        text_.Fail(child, fmt::format("a second <default class=\"{}\">", *name));
        continue;
      }
      classes_.emplace_back().parent = into;
      Read(child, index);
      continue;
    }
    const std::string kind = ToLower(child.name);
    if (!HasDefaults(kind)) continue;
    auto& values = classes_[static_cast<std::size_t>(into)].values[kind];
    for (const auto& [key, value] : child.attributes) values[ToLower(key)] = value;
  }
}

int MjcfDefaults::Find(const std::string& name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? -1 : found->second;
}

int MjcfDefaults::ClassOf(const XmlElement& element, int childclass, const char* attribute) const {
  const std::string* name = element.FindAttribute(attribute);
  if (name == nullptr) return childclass;
  const int found = Find(*name);
  if (found >= 0) return found;
  text_.Fail(element, fmt::format("<{} {}=\"{}\">: there is no <default> of that class",
                                  element.name, attribute, *name));
  return childclass;
}

std::vector<const std::string*> MjcfDefaults::Values(int of_class, std::string_view element,
                                                     std::string_view attribute) const {
  std::vector<const std::string*> found;
  for (; of_class >= 0; of_class = classes_[static_cast<std::size_t>(of_class)].parent) {
    const auto& all = classes_[static_cast<std::size_t>(of_class)].values;
    const auto values = all.find(element);
    if (values == all.end()) continue;
    const auto value = values->second.find(attribute);
    if (value != values->second.end()) found.push_back(&value->second);
  }
  std::reverse(found.begin(), found.end());
  return found;
}

const std::string* MjcfDefaults::Value(int of_class, std::string_view element,
                                       std::string_view attribute) const {
  const std::vector<const std::string*> all = Values(of_class, element, attribute);
  return all.empty() ? nullptr : all.back();
}

std::string_view MjcfDefaults::FirstOf(int of_class, std::string_view element,
                                       const std::vector<std::string_view>& attributes) const {
  for (; of_class >= 0; of_class = classes_[static_cast<std::size_t>(of_class)].parent) {
    const auto& all = classes_[static_cast<std::size_t>(of_class)].values;
    const auto values = all.find(element);
    if (values == all.end()) continue;
    for (const std::string_view attribute : attributes) {
      if (values->second.count(attribute) > 0) return attribute;
    }
  }
  return {};
}

}  // namespace mmm_converter
