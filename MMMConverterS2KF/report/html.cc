// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/html.h"

#include "MMMConverterS2KF/report/packed_array.h"
#include "MMMConverterS2KF/report/page_sources.h"

namespace mmm_converter {
namespace {

std::string PolicyOf(const Script& script) {
  return " 'sha256-" + EncodeBase64(script.sha256) + "'";
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

// < occurs in strings of JSON only, where \u003c says the same.
std::string DataBlock(std::string_view name, std::string_view json) {
  std::string block = "<script type=\"application/json\" class=\"" + std::string(name) + "\">";
  block.reserve(block.size() + json.size());
  for (const char c : json) {
    if (c == '<') {
      block += "\\u003c";
    } else {
      block += c;
    }
  }
  return block + "</script>\n";
}

std::string FillPage(std::string_view page,
                     const std::map<std::string_view, std::string_view>& texts) {
  std::string filled;
  while (true) {
    const std::size_t begin = page.find("{{");
    if (begin == std::string_view::npos) break;
    const std::size_t end = page.find("}}", begin);
    filled += page.substr(0, begin);
    filled += texts.at(page.substr(begin + 2, end - begin - 2));
    page.remove_prefix(end + 2);
  }
  filled += page;
  return filled;
}

std::string FormatPage(const Page& page) {
  const std::string title = EscapeHtml(page.title);
  std::string hashes = PolicyOf(page.script);
  std::string libraries;
  if (!page.libraries.empty()) libraries.append("<!--\n").append(LibraryLicences()).append("-->\n");
  for (const Script& library : page.libraries) {
    hashes += PolicyOf(library);
    libraries.append("<script>").append(library.text).append("</script>\n");
  }
  return FillPage(PageFrame(), {{"title", title},
                                {"hashes", hashes},
                                {"policy", page.policy},
                                {"styles", page.styles},
                                {"content", page.content},
                                {"data", page.data},
                                {"libraries", libraries},
                                {"script", page.script.text}});
}

}  // namespace mmm_converter
