// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_document.h"

#include <fmt/core.h>
#include <tinyxml2.h>

#include <algorithm>

#include "common/io/bytes/foreign_content.h"
#include "common/io/xml/xml_scanner.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

std::string Explain(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
    case tinyxml2::XML_ERROR_PARSING:  // at its end
      return "an element is closed by another name, or never closed: its end tag is missing";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "a tag has no >, or a name that is none";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "there is text outside of the elements, or the end tag behind a text is missing";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment has no -->";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is not of the form name=\"value\"";
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "there is no element";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deeply";
    default:
      return tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID());
  }
}

/// How many siblings there are from `first` on.
template <typename Node, typename Next>
std::size_t Count(const Node* first, const Next& next) {
  std::size_t count = 0;
  for (const Node* node = first; node != nullptr; node = next(node)) ++count;
  return count;
}

XmlElement Convert(const tinyxml2::XMLElement& source, int first_line) {
  XmlElement element;
  element.name = source.Name();
  element.line = first_line - 1 + source.GetLineNum();
  element.attributes.reserve(
      Count(source.FirstAttribute(), [](const auto* attribute) { return attribute->Next(); }));
  for (const auto* a = source.FirstAttribute(); a != nullptr; a = a->Next()) {
    element.attributes.emplace_back(a->Name(), a->Value());
  }
  element.children.reserve(Count(source.FirstChildElement(),
                                 [](const auto* child) { return child->NextSiblingElement(); }));
  for (const auto* node = source.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (const auto* child = node->ToElement()) {
      element.children.push_back(Convert(*child, first_line));
    } else if (const auto* text = node->ToText()) {
      element.text += text->Value();
    }
  }
  element.text = Trim(element.text);
  return element;
}

/// The parser compares each attribute with all before it.
constexpr std::ptrdiff_t kMostAttributes = 256;

/// @throws Error where the tag that the scanner is at has more attributes. `equals`: signs in it.
void CheckAttributes(const XmlScanner& scanner, std::ptrdiff_t equals, const std::string& file,
                     int first_line) {
  if (equals <= kMostAttributes) return;
  const std::string_view tag = scanner.markup();
  std::ptrdiff_t attributes = 0;
  for (std::size_t at = 0; (at = tag.find_first_of("\"'", at)) != std::string_view::npos; ++at) {
    ++attributes;
    at = std::min(tag.find(tag[at], at + 1), tag.size());
  }
  if (attributes <= kMostAttributes) return;
  throw Error(fmt::format("{}:{}: <{}> has {} attributes, more than the {} that are read", file,
                          first_line - 1 + scanner.line(), scanner.name(), attributes,
                          kMostAttributes));
}

/// What the parser and the tree take for one of each [bytes], measured, and what they may take.
constexpr double kBytesOfElement = 240;
constexpr double kBytesOfAttribute = 180;
constexpr double kBytesOfOther = 112;  // a text, a comment
constexpr double kMostBytesPerByte = 16;
constexpr double kFreeBytes = 32 << 20;

/// @throws Error where the tree would take much more memory than the text.
void CheckBeforeParsing(std::string_view content, const std::string& file, int first_line) {
  const ByteSource bytes = BytesOf(content);
  XmlScanner scanner(bytes);
  std::ptrdiff_t elements = 0;
  std::ptrdiff_t attributes = 0;
  std::ptrdiff_t others = 0;
  while (scanner.Next()) {
    if (!Trim(scanner.before()).empty()) ++others;
    if (scanner.kind() == XmlScanner::Markup::kOther) ++others;
    if (!scanner.IsElement()) continue;
    const std::string_view tag = scanner.markup();
    const std::ptrdiff_t equals = std::count(tag.begin(), tag.end(), '=');
    CheckAttributes(scanner, equals, file, first_line);
    ++elements;
    attributes += equals;
  }
  const double needed = kBytesOfElement * static_cast<double>(elements) +
                        kBytesOfAttribute * static_cast<double>(attributes) +
                        kBytesOfOther * static_cast<double>(others);
  if (needed <= kFreeBytes + kMostBytesPerByte * static_cast<double>(content.size())) return;
  throw Error(fmt::format(
      "{}: its {} bytes are {} elements, {} attributes and {} texts or comments, so short that "
      "they would take {:.0f} MB of memory; no file of a known kind is so",
      file, content.size(), elements, attributes, others, 1e-6 * needed));
}

void Parse(std::string_view content, const std::string& file, int first_line,
           tinyxml2::XMLDocument* document) {
  CheckBeforeParsing(content, file, first_line);
  document->Parse(content.data(), content.size());
  if (!document->Error()) return;
  const std::string foreign = NameForeignContent(content.substr(0, 64));
  if (!foreign.empty()) throw Error(fmt::format("{}: {}", file, foreign));
  throw Error(fmt::format("{}:{}: not well-formed XML: {}", file,
                          first_line - 1 + document->ErrorLineNum(), Explain(*document)));
}

}  // namespace

bool XmlElement::Is(std::string_view other_name) const {
  return EqualIgnoringCase(name, other_name);
}

const XmlElement* XmlElement::FindChild(std::string_view child_name) const {
  for (const XmlElement& child : children) {
    if (child.Is(child_name)) return &child;
  }
  return nullptr;
}

std::vector<const XmlElement*> XmlElement::FindChildren(std::string_view child_name) const {
  std::vector<const XmlElement*> found;
  for (const XmlElement& child : children) {
    if (child.Is(child_name)) found.push_back(&child);
  }
  return found;
}

const std::string* XmlElement::FindAttribute(std::string_view attribute_name) const {
  for (const auto& [key, value] : attributes) {
    if (EqualIgnoringCase(key, attribute_name)) return &value;
  }
  return nullptr;
}

std::vector<std::string> XmlElement::AttributesBeside(const std::vector<std::string>& names) const {
  std::vector<std::string> others;
  for (const auto& [key, value] : attributes) {
    if (key.starts_with("xmlns") || key.starts_with("xsi:")) continue;
    if (std::find(names.begin(), names.end(), key) == names.end()) others.push_back(key);
  }
  return others;
}

XmlElement ParseXml(std::string_view content, const std::string& file) {
  tinyxml2::XMLDocument document;
  Parse(content, file, 1, &document);
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr) {
    throw Error(fmt::format("{}:1: not well-formed XML: there is no element", file));
  }
  if (const auto* second = root->NextSiblingElement()) {
    throw Error(fmt::format("{}:{}: not well-formed XML: <{}> is a second root beside <{}>", file,
                            second->GetLineNum(), second->Name(), root->Name()));
  }
  return Convert(*root, 1);
}

void ParseXmlElements(std::string_view content, const std::string& file, int first_line,
                      const std::function<void(const XmlElement&)>& visit) {
  tinyxml2::XMLDocument document;
  Parse(content, file, first_line, &document);
  if (!visit) return;
  for (const auto* element = document.FirstChildElement(); element != nullptr;
       element = element->NextSiblingElement()) {
    visit(Convert(*element, first_line));
  }
}

XmlElement ReadXmlFile(const std::string& path, std::size_t max_bytes) {
  return ParseXml(ReadFileContent(path, max_bytes), path);
}

}  // namespace mmm_converter
