// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/mjcf/mjcf_text.h"
#include "common/io/xml/xml_document.h"

namespace mmm_converter {

/// The classes of `<default>`: a class has what its parent has, but for what it says itself. The
/// outermost is class 0, "main".
class MjcfDefaults {
 public:
  explicit MjcfDefaults(MjcfText* text);

  /// -1: there is no such class.
  int Find(const std::string& name) const;
  /// The class of an element: its own, else childclass. What is wrong is an error of the text.
  int ClassOf(const XmlElement& element, int childclass, const char* attribute) const;

  /// An attribute's value for elements called `element`, of the class or the nearest one around it.
  /// nullptr: none has it.
  const std::string* Value(int of_class, std::string_view element,
                           std::string_view attribute) const;
  /// All of them, outermost class first.
  std::vector<const std::string*> Values(int of_class, std::string_view element,
                                         std::string_view attribute) const;
  /// Which of the attributes the nearest class that has any has. Empty: none.
  std::string_view FirstOf(int of_class, std::string_view element,
                           const std::vector<std::string_view>& attributes) const;

 private:
  struct Class {
    int parent = -1;
    std::map<std::string, std::map<std::string, std::string, std::less<>>, std::less<>> values;
  };

  void Read(const XmlElement& element, int into);

  MjcfText& text_;
  std::vector<Class> classes_;
  std::map<std::string, int> by_name_;
};

}  // namespace mmm_converter
