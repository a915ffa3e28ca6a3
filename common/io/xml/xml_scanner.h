// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/bytes/file_content.h"

namespace mmm_converter {

/// Where markup begins and ends in XML that need not be in memory as a whole. Reads neither names
/// nor attributes; what is wrong is for ParseXml to say.
class XmlScanner {
 public:
  enum class Markup { kStartTag, kEndTag, kEmptyTag, kOther };

  explicit XmlScanner(const ByteSource& content);  ///< must outlive this

  /// On to the next markup. false: there is none, or none that ends; markup() is then what is left.
  bool Next();

  Markup kind() const { return kind_; }
  bool IsElement() const { return kind_ == Markup::kStartTag || kind_ == Markup::kEmptyTag; }
  // Views are valid until Next().
  std::string_view before() const { return View(0, before_); }        ///< text before the markup
  std::string_view markup() const { return View(before_, length_); }  ///< from < to >
  std::string_view name() const;                                      ///< of a start or empty tag
  std::uint64_t begin() const { return read_ - buffer_.size() + at_ + before_; }
  std::uint64_t end() const { return begin() + length_; }
  int line() const { return line_; }  ///< of begin(), from 1
  int end_line() const;               ///< of end()

 private:
  std::string_view View(std::size_t from, std::size_t length) const {
    return std::string_view(buffer_).substr(at_ + from, length);
  }
  std::string_view Rest() const { return std::string_view(buffer_).substr(at_); }
  bool Grow();
  std::size_t Find(std::string_view what, std::size_t from);
  bool StartsWith(std::string_view what, std::size_t from);
  std::size_t EndOfMarkup(std::size_t from);
  std::size_t EndOfTag(std::size_t from);

  const ByteSource& content_;
  std::string buffer_;
  std::size_t at_ = 0;      // in the buffer, of before()
  std::uint64_t read_ = 0;  // bytes of the content, up to the buffer's end
  std::size_t before_ = 0, length_ = 0;
  int line_ = 1;
  Markup kind_ = Markup::kOther;
};

/// Where an element stands in the text of a file, in bytes.
struct XmlRange {
  std::string name;
  std::uint64_t begin = 0;        ///< of the start tag
  std::uint64_t inner_begin = 0;  ///< after the start tag; as inner_end and end in `<a/>`
  std::uint64_t inner_end = 0;
  std::uint64_t end = 0;  ///< after the end tag
  std::vector<XmlRange> children;
};

/// The root element with its descendants down to `depth` levels below it. `content` must be what
/// ParseXml accepts; `file` is only named in messages.
/// @throws Error where the elements can't be told apart, as with blanks behind a <.
XmlRange FindXmlRanges(const ByteSource& content, const std::string& file, int depth);

}  // namespace mmm_converter
