// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_scanner.h"

#include <algorithm>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kBlockBytes = 1 << 20;
constexpr auto kNowhere = std::string_view::npos;

int Lines(std::string_view text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

XmlScanner::XmlScanner(const ByteSource& content) : content_(content) {}

bool XmlScanner::Next() {
  line_ = end_line();
  at_ += before_ + length_;
  before_ = length_ = 0;
  const std::size_t start = Find("<", 0);
  const std::size_t end = start == kNowhere ? kNowhere : EndOfMarkup(start);
  if (end == kNowhere) {
    length_ = Rest().size();
    return false;
  }
  before_ = start;
  length_ = end - start;
  line_ += Lines(before());
  return true;
}

int XmlScanner::end_line() const { return line_ + Lines(markup()); }

std::string_view XmlScanner::name() const {
  const std::string_view inside = markup().substr(1);
  return inside.substr(0, inside.find_first_of(" \t\r\n/>"));
}

/// Reads another block; forgets what is behind. false: there is no more.
bool XmlScanner::Grow() {
  if (read_ == content_.size) return false;
  buffer_.erase(0, at_);
  at_ = 0;
  const std::size_t old_size = buffer_.size();
  // Doubled where something is long, so that the time stays linear.
  const std::uint64_t count =
      std::min<std::uint64_t>(std::max(kBlockBytes, old_size), content_.size - read_);
  buffer_.resize(old_size + count);
  content_.read(read_, count, buffer_.data() + old_size);
  read_ += count;
  return true;
}

std::size_t XmlScanner::Find(std::string_view what, std::size_t from) {
  for (;;) {
    const std::size_t found = Rest().find(what, from);
    if (found != kNowhere) return found;
    const std::size_t searched = Rest().size() - std::min(Rest().size(), what.size() - 1);
    from = std::max(from, searched);
    if (!Grow()) return kNowhere;
  }
}

bool XmlScanner::StartsWith(std::string_view what, std::size_t from) {
  while (Rest().size() < from + what.size() && Grow()) {
  }
  return Rest().substr(from).starts_with(what);
}

std::size_t XmlScanner::EndOfMarkup(std::size_t from) {
  const auto behind = [&](std::string_view end, std::size_t start) {
    const std::size_t found = Find(end, from + start);
    return found == kNowhere ? kNowhere : found + end.size();
  };
  kind_ = Markup::kOther;
  if (StartsWith("<!--", from)) return behind("-->", 4);
  if (StartsWith("<![CDATA[", from)) return behind("]]>", 9);
  if (StartsWith("<!", from)) return behind(">", 2);
  if (StartsWith("<?", from)) return behind("?>", 2);
  if (StartsWith("</", from)) {
    kind_ = Markup::kEndTag;
    return behind(">", 2);
  }
  return EndOfTag(from);
}

/// A > in quotes does not end it.
std::size_t XmlScanner::EndOfTag(std::size_t from) {
  std::string_view rest = Rest();
  for (std::size_t i = from + 1;; ++i) {
    if (i == rest.size()) {
      if (!Grow()) return kNowhere;
      rest = Rest();
    }
    if (rest[i] == '>') {
      kind_ = rest[i - 1] == '/' ? Markup::kEmptyTag : Markup::kStartTag;
      return i + 1;
    }
    if (rest[i] != '"' && rest[i] != '\'') continue;
    i = Find(rest[i] == '"' ? "\"" : "'", i + 1);
    if (i == kNowhere) return kNowhere;
    rest = Rest();
  }
}

XmlRange FindXmlRanges(const ByteSource& content, const std::string& file, int depth) {
  std::vector<XmlRange> open(1);  // a document around the root, then the elements that are open
  std::size_t too_deep = 0;       // open elements below the wanted depth
  XmlScanner scanner(content);
  // What is behind the root, ParseXml has judged.
  while (open.front().children.empty() && scanner.Next()) {
    if (scanner.kind() == XmlScanner::Markup::kEndTag && too_deep > 0) {
      --too_deep;
    } else if (scanner.kind() == XmlScanner::Markup::kEndTag && open.size() > 1) {
      XmlRange closed = std::move(open.back());
      closed.inner_end = scanner.begin();
      closed.end = scanner.end();
      open.pop_back();
      open.back().children.push_back(std::move(closed));
    } else if (scanner.IsElement()) {
      const bool is_closed = scanner.kind() == XmlScanner::Markup::kEmptyTag;
      if (open.size() > static_cast<std::size_t>(depth) + 1) {
        too_deep += is_closed ? 0 : 1;
        continue;
      }
      const std::uint64_t end = scanner.end();
      XmlRange range{std::string(scanner.name()), scanner.begin(), end, end, end, {}};
      (is_closed ? open.back().children : open).push_back(std::move(range));
    }
  }
  if (open.front().children.empty()) {
    throw Error(file + ": not well-formed XML: an element is never closed");
  }
  return std::move(open.front().children.front());
}

}  // namespace mmm_converter
