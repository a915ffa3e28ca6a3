// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_edit.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr int kDeepest = 200;  // models of OpenSim have 15 levels

void CheckIsSame(const XmlElement& element, const XmlRange& range, const std::string& file) {
  if (!element.Is(range.name) || element.children.size() != range.children.size()) {
    throw Error(
        fmt::format("{}:{}: <{:.60}>: its elements can't be told apart, or are nested more "
                    "than {} deep",
                    file, element.line, element.name, kDeepest));
  }
  for (std::size_t i = 0; i < element.children.size(); ++i) {
    CheckIsSame(element.children[i], range.children[i], file);
  }
}

}  // namespace

XmlPlace XmlPlace::Child(std::string_view name) const {
  if (element_ == nullptr) return {};
  for (std::size_t i = 0; i < element_->children.size(); ++i) {
    if (element_->children[i].Is(name)) return {element_->children[i], range_->children[i]};
  }
  return {};
}

std::vector<XmlPlace> XmlPlace::Children() const {
  std::vector<XmlPlace> all;
  for (std::size_t i = 0; element_ != nullptr && i < element_->children.size(); ++i) {
    all.emplace_back(element_->children[i], range_->children[i]);
  }
  return all;
}

XmlEdit::XmlEdit(std::string_view content, const std::string& file)
    : content_(content),
      element_(ParseXml(content, file)),
      range_(FindXmlRanges(BytesOf(content), file, kDeepest)) {
  CheckIsSame(element_, range_, file);
}

void XmlEdit::SetInner(const XmlPlace& place, const std::string& xml) {
  const XmlRange& range = place.range();
  if (range.inner_begin < range.end) {
    changes_.push_back({range.inner_begin, range.inner_end, xml});
    return;
  }
  // `<a b="c" />` opens, holds, and closes.
  const std::string_view tag = content_.substr(range.begin, range.end - range.begin);
  const std::string_view opened = Trim(tag.substr(0, tag.rfind('/')));
  changes_.push_back({range.begin, range.end, fmt::format("{}>{}</{}>", opened, xml, range.name)});
}

void XmlEdit::SetProperty(const XmlPlace& owner, const std::string& name, const std::string& text) {
  if (const XmlPlace property = owner.Child(name)) {
    SetInner(property, text);
  } else {
    Append(owner, fmt::format("<{0}>{1}</{0}>", name, text));
  }
}

void XmlEdit::Append(const XmlPlace& owner, const std::string& xml) {
  const XmlRange& range = owner.range();
  if (range.inner_begin == range.end) {
    const auto before =
        std::find_if(changes_.begin(), changes_.end(), [&range](const Change& change) {
          return change.begin == range.begin && change.end == range.end;
        });
    if (before == changes_.end()) return SetInner(owner, xml);
    before->text.insert(before->text.rfind('<'), xml);
    return;
  }
  const std::uint64_t at = range.children.empty() ? range.inner_begin : range.children.back().end;
  changes_.push_back({at, at, xml});
}

void XmlEdit::Wrap(const XmlPlace& place, const std::string& before, const std::string& behind) {
  changes_.push_back({place.range().begin, place.range().begin, before});
  changes_.push_back({place.range().end, place.range().end, behind});
}

std::string XmlEdit::Finish() {
  std::stable_sort(changes_.begin(), changes_.end(),
                   [](const Change& a, const Change& b) { return a.begin < b.begin; });
  std::string text;
  std::uint64_t at = 0;
  for (const Change& change : changes_) {
    text.append(content_.substr(at, change.begin - at)).append(change.text);
    at = change.end;
  }
  text.append(content_.substr(at));
  changes_.clear();
  return text;
}

}  // namespace mmm_converter
