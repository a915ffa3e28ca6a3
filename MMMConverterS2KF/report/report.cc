// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/report.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "MMMConverterS2KF/report/tracks.h"

namespace mmm_converter {
namespace {

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

// A data block that no content can end: < occurs in strings of JSON only, where \u003c says the
// same.
std::string DataBlock(std::string_view name, std::string_view json) {
  std::string block = "<script type=\"application/json\" class=\"" + std::string(name) + "\">";
  for (const char c : json) {
    if (c == '<') {
      block += "\\u003c";
    } else {
      block += c;
    }
  }
  return block + "</script>\n";
}

std::string FormatData(const std::vector<ReportSection>& sections) {
  std::string blocks;
  for (const ReportSection& section : sections) {
    const nlohmann::json heading = {{"title", section.title}, {"text", section.text}};
    blocks += DataBlock("heading",
                        heading.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    blocks += DataBlock("figures", FormatComparisonJson(*section.comparison));
    blocks += DataBlock("tracks", FormatTracks(*section.comparison));
  }
  return blocks;
}

// The template with its places filled; what is filled in is not looked at again.
std::string Fill(std::string_view page, const std::map<std::string_view, std::string_view>& texts) {
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

}  // namespace

std::string FormatReport(const std::string& title, const std::vector<ReportSection>& sections) {
  const std::string escaped_title = EscapeHtml(title);
  const std::string data = FormatData(sections);
  return Fill(PageTemplate(), {{"title", escaped_title},
                               {"styles", PageStyles()},
                               {"licences", LibraryLicences()},
                               {"scene_library", SceneLibrary()},
                               {"plot_library", PlotLibrary()},
                               {"script", PageScript()},
                               {"data", data}});
}

}  // namespace mmm_converter
