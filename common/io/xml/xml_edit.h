// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_scanner.h"

namespace mmm_converter {

/// An element and where it stands in the text. Empty: there is none.
class XmlPlace {
 public:
  XmlPlace() = default;
  XmlPlace(const XmlElement& element, const XmlRange& range) : element_(&element), range_(&range) {}

  explicit operator bool() const { return element_ != nullptr; }
  const XmlElement& element() const { return *element_; }
  const XmlRange& range() const { return *range_; }

  XmlPlace Child(std::string_view name) const;  ///< the first; empty: none, or this is empty
  std::vector<XmlPlace> Children() const;

 private:
  const XmlElement* element_ = nullptr;
  const XmlRange* range_ = nullptr;
};

/// Changes of an XML file's text. What is not asked to change stays byte for byte.
class XmlEdit {
 public:
  /// content: must outlive this, as ParseXml takes it. @throws Error as ParseXml, and where
  /// elements can't be told apart or are nested too deeply.
  XmlEdit(std::string_view content, const std::string& file);

  XmlPlace root() const { return {element_, range_}; }

  /// What stands between the tags, as XML.
  void SetInner(const XmlPlace& place, const std::string& xml);
  /// The text of a child, which is appended where there is none. `text` needs no escapes.
  void SetProperty(const XmlPlace& owner, const std::string& name, const std::string& text);
  /// Behind the last child.
  void Append(const XmlPlace& owner, const std::string& xml);
  void Wrap(const XmlPlace& place, const std::string& before, const std::string& behind);

  /// The text with all changes, which may not overlap.
  std::string Finish();

 private:
  struct Change {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    std::string text;
  };

  std::string_view content_;
  XmlElement element_;
  XmlRange range_;
  std::vector<Change> changes_;
};

}  // namespace mmm_converter
