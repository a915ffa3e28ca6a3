// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/report.h"

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "MMMConverterS2KF/report/tracks.h"

namespace mmm_converter {
namespace {

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

}  // namespace

std::string FormatReport(const std::string& title, const std::vector<ReportSection>& sections) {
  const std::string data = FormatData(sections);
  return FormatPage({.title = title,
                     .styles = PageStyles(),
                     .content = PageContent(),
                     .data = data,
                     .libraries = {SceneLibrary(), PlotLibrary()},
                     .script = PageScript()});
}

}  // namespace mmm_converter
