// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// The position after the next `what`, or the end of the text.
std::size_t After(std::string_view content, std::string_view what, std::size_t from) {
  const std::size_t found = content.find(what, from);
  return found == std::string_view::npos ? content.size() : found + what.size();
}

std::string_view NameAt(std::string_view content, std::size_t begin) {
  return content.substr(begin, content.find_first_of(" \t\r\n/>", begin) - begin);
}

}  // namespace

std::string EscapeXml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : ToUtf8(text)) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&apos;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string FormatXmlComment(std::string_view text) {
  std::string comment = "<!-- ";
  for (const char c : EscapeXml(text)) {
    if (c == '-' && comment.back() == '-') comment += ' ';
    comment += c;
  }
  return comment + " -->";
}

void AppendDecimal(double value, int decimals, std::string* out) {
  constexpr std::array<double, 13> kScales = {1e0, 1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                              1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
  constexpr double kMostExact = 9e15;  // whole numbers up to there are exact in double precision
  std::array<char, 400> buffer{};      // holds the largest double
  const double scaled = value * kScales[static_cast<std::size_t>(decimals)];
  if (std::abs(scaled) > kMostExact) {
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                            std::chars_format::fixed, 0);
    out->append(buffer.data(), end);
    return;
  }
  std::int64_t digits = std::llround(scaled);
  if (digits < 0) out->push_back('-');
  digits = std::abs(digits);
  int left = decimals;
  for (; left > 0 && digits % 10 == 0; --left) digits /= 10;
  char* const end = buffer.data() + buffer.size();
  char* begin = end;
  for (; left > 0; --left, digits /= 10) *--begin = static_cast<char>('0' + digits % 10);
  if (begin != end) *--begin = '.';
  do {
    *--begin = static_cast<char>('0' + digits % 10);
    digits /= 10;
  } while (digits > 0);
  out->append(begin, end);
}

std::string_view RootName(std::string_view content) {
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  for (;;) {
    content.remove_prefix(std::min(content.find_first_not_of(kBlanks), content.size()));
    if (content.starts_with("<!--")) {
      content.remove_prefix(After(content, "-->", 4));
    } else if (content.starts_with("<!") && content.find('[') < content.find('>')) {
      content.remove_prefix(After(content, "]>", 2));  // declares entities
    } else if (content.starts_with("<?") || content.starts_with("<!")) {
      content.remove_prefix(After(content, ">", 2));
    } else if (content.starts_with('<')) {
      return NameAt(content, 1);
    } else {
      return {};
    }
  }
}

}  // namespace mmm_converter
