// SPDX-License-Identifier: MIT
#include "common/io/xml/long_xml.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Markup = XmlScanner::Markup;

constexpr std::uint64_t kMostBytesOfARun = 1 << 18;

}  // namespace

LongXml::LongXml(ByteSource content, std::string file, std::vector<std::string> many,
                 int highest_level)
    : content_(std::move(content)),
      file_(std::move(file)),
      many_(std::move(many)),
      highest_level_(highest_level) {
  root_ = ParseXml(CutRuns(), file_);
}

/// The text with a stand-in for every run: an element that has its number. Lines stay where they
/// are.
std::string LongXml::CutRuns() {
  std::string text;
  XmlScanner scanner(content_);
  int level = 0;
  bool in_run = false;
  while (scanner.Next()) {
    text += scanner.before();
    if (level >= highest_level_ && scanner.IsElement() && IsOfMany(scanner.name())) {
      in_run = in_run && Trim(scanner.before()).empty() &&
               scanner.end() - runs_.back().begin < kMostBytesOfARun;
      if (!in_run) text += fmt::format("<{0}>{1}</{0}>", scanner.name(), runs_.size());
      if (!in_run) runs_.push_back({scanner.begin(), 0, scanner.line()});
      text.append(TakeElement(&scanner), '\n');
      runs_.back().end = scanner.end();
      in_run = true;
      continue;
    }
    in_run = false;
    text += scanner.markup();
    if (scanner.kind() == Markup::kStartTag) ++level;
    if (scanner.kind() == Markup::kEndTag) --level;
  }
  text += scanner.markup();
  return text;
}

/// On to the end of the element whose start the scanner is at; returns how many lines it has.
int LongXml::TakeElement(XmlScanner* scanner) const {
  const std::string name(scanner->name());
  const int line = scanner->line();
  for (int depth = scanner->kind() == Markup::kStartTag ? 1 : 0; depth > 0;) {
    if (!scanner->Next()) {
      throw Error(
          fmt::format("{}:{}: not well-formed XML: <{}> is never closed", file_, line, name));
    }
    if (scanner->kind() == Markup::kStartTag) ++depth;
    if (scanner->kind() == Markup::kEndTag) --depth;
  }
  return scanner->end_line() - line;
}

bool LongXml::IsOfMany(std::string_view name) const {
  return std::any_of(many_.begin(), many_.end(),
                     [name](const std::string& one) { return EqualIgnoringCase(one, name); });
}

std::string LongXml::BytesOf(const Run& run) const {
  std::string bytes(run.end - run.begin, '\0');
  content_.read(run.begin, bytes.size(), bytes.data());
  return bytes;
}

void LongXml::ForEachChild(const XmlElement& parent, std::string_view name,
                           const std::function<void(const XmlElement&)>& visit) {
  for (const XmlElement& child : parent.children) {
    if (!child.Is(name)) continue;
    const long number = ParseLong(child.text).value_or(-1);
    if (number < 0 || number >= static_cast<long>(runs_.size())) {
      throw Error(fmt::format("{}:{}: not well-formed XML: <{}> is out of place", file_, child.line,
                              child.name));
    }
    Run& run = runs_[number];
    ParseXmlElements(BytesOf(run), file_, run.line, visit);
    run.is_checked = true;
  }
}

void LongXml::CheckTheRest() {
  for (Run& run : runs_) {
    if (!std::exchange(run.is_checked, true)) {
      ParseXmlElements(BytesOf(run), file_, run.line, {});
    }
  }
}

}  // namespace mmm_converter
