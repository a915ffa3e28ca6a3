// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/io/xml/xml_document.h"
#include "common/io/xml/xml_scanner.h"

namespace mmm_converter {

/// XML of which the elements of some names may be too many for memory: they are not in the tree,
/// but parsed where they stand when they are asked for. Such elements count from `highest_level`
/// below the root on.
class LongXml {
 public:
  /// many: names, in any case. `file` is only named in messages.
  /// @throws Error as ParseXml.
  LongXml(ByteSource content, std::string file, std::vector<std::string> many, int highest_level);

  const XmlElement& root() const { return root_; }

  /// Calls visit for each child of that name, one after the other; `parent` is in the tree.
  /// @throws Error as ParseXml.
  void ForEachChild(const XmlElement& parent, std::string_view name,
                    const std::function<void(const XmlElement&)>& visit);

  /// @throws Error as ParseXml, where an element that has not been visited is not well-formed.
  void CheckTheRest();

 private:
  /// Elements one after the other, with nothing but white space between them.
  struct Run {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    int line = 0;
    bool is_checked = false;
  };

  std::string CutRuns();
  int TakeElement(XmlScanner* scanner) const;
  bool IsOfMany(std::string_view name) const;
  std::string BytesOf(const Run& run) const;

  ByteSource content_;
  std::string file_;
  std::vector<std::string> many_;
  int highest_level_;
  std::vector<Run> runs_;
  XmlElement root_;
};

}  // namespace mmm_converter
