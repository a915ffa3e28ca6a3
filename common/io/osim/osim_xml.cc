// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_xml.h"

#include <fmt/format.h>

#include "common/io/xml/xml_scanner.h"
#include "common/io/xml/xml_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr const char* kRoot = "OpenSimDocument";

}  // namespace

std::string_view FirstElement(std::string_view content) {
  const ByteSource bytes = BytesOf(content);
  XmlScanner scanner(bytes);
  int depth = 0;
  while (scanner.Next()) {
    using Markup = XmlScanner::Markup;
    if (scanner.kind() == Markup::kStartTag) ++depth;
    if (scanner.kind() == Markup::kEndTag) --depth;
    const bool is_tag = scanner.kind() != Markup::kOther;
    if (is_tag && depth <= 0) return content.substr(0, scanner.end());
  }
  return content;
}

bool IsOsimDocument(std::string_view content) {
  return EqualIgnoringCase(RootName(content), kRoot);
}

bool IsOsimPart(std::string_view content, const char* set) {
  return IsOsimDocument(content) || EqualIgnoringCase(RootName(content), set);
}

XmlElement ParseOsimXml(std::string_view content, const std::string& file) {
  XmlElement root = ParseXml(FirstElement(content), file);
  if (root.Is(kRoot)) return root;
  throw Error(fmt::format("{}:{}: <{:.60}> is not <{}>, the root of an OpenSim file", file,
                          root.line, root.name, kRoot));
}

int ReadOsimVersion(const XmlElement& root, const std::string& file) {
  const std::string* text = root.FindAttribute("Version");
  const std::optional<long> version = text == nullptr ? std::nullopt : ParseLong(*text);
  if (!version) {
    throw Error(fmt::format("{}:{}: <{}> says no Version=\"40000\"", file, root.line, kRoot));
  }
  const bool is_old = *version >= 10901 && *version < 30500;
  const bool is_new = *version >= 40000 && *version < 50000;
  if (is_old || is_new) return static_cast<int>(*version);
  throw Error(
      fmt::format("{}:{}: Version {} of OpenSim's files is not read; 10901 to 30499 and "
                  "40000 to 49999 are: open the model in OpenSim 4 and save it",
                  file, root.line, *version));
}

XmlElement ParseOsimPart(std::string_view content, const std::string& file, const char* set) {
  if (EqualIgnoringCase(RootName(content), set)) return ParseXml(FirstElement(content), file);
  XmlElement root = ParseOsimXml(content, file);
  const XmlElement* element = root.FindChild(set);
  if (element != nullptr) return *element;
  throw Error(fmt::format("{}:{}: holds no <{}>", file, root.line, set));
}

}  // namespace mmm_converter
