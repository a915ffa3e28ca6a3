// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/io/bytes/file_content.h"

namespace mmm_converter {

/// An XML element with all that is below it. Names of elements and attributes are found in any
/// case.
struct XmlElement {
  std::string name;  ///< as written
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;
  std::string text;  ///< directly inside this element, trimmed, entities resolved
  int line = 0;      ///< where the element starts

  bool Is(std::string_view other_name) const;
  const XmlElement* FindChild(std::string_view child_name) const;  ///< the first; nullptr: none
  std::vector<const XmlElement*> FindChildren(std::string_view child_name) const;
  const std::string* FindAttribute(std::string_view attribute_name) const;  ///< nullptr: none
  /// Attributes other than these and than those by which a file names its schema, as written.
  std::vector<std::string> AttributesBeside(const std::vector<std::string>& names) const;
};

/// Parses XML text; `file` is only named in messages. Comments and declarations are dropped,
/// entities other than the predefined ones are not resolved.
/// @throws Error `file:line: ...` where it is not well-formed.
XmlElement ParseXml(std::string_view content, const std::string& file);

/// Parses elements that stand one after the other, without a root around them, from line
/// first_line on, and calls visit for each; visit may be empty.
/// @throws Error as ParseXml.
void ParseXmlElements(std::string_view content, const std::string& file, int first_line,
                      const std::function<void(const XmlElement&)>& visit);

/// @throws Error as ReadFileContent and ParseXml.
XmlElement ReadXmlFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

}  // namespace mmm_converter
