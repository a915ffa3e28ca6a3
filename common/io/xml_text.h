// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mmm_converter {

/// Text for an attribute value or an element: markup escaped, bytes that are not UTF-8 taken as
/// Latin-1, control characters (which XML can't hold) as blanks.
std::string EscapeXml(std::string_view text);

/// Appends a number rounded to so many decimals (at most 12), without trailing zeros and never as
/// "-0". value must be finite.
void AppendDecimal(double value, int decimals, std::string* out);

/// The name of the root of a text that starts like XML; empty: it does not.
std::string_view RootName(std::string_view content);

/// Where an element stands in the text of a file, in bytes.
struct XmlRange {
  std::string_view name;
  std::size_t begin = 0;        ///< of the start tag
  std::size_t inner_begin = 0;  ///< after the start tag; inner_begin == inner_end == end in <a/>
  std::size_t inner_end = 0;
  std::size_t end = 0;  ///< after the end tag
  std::vector<XmlRange> children;
};

/// The root element with its descendants down to `depth` levels below it. `content` must be what
/// ParseXml accepts; it must outlive the result.
XmlRange FindXmlRanges(std::string_view content, int depth);

}  // namespace mmm_converter
