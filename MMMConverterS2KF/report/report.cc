// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/report.h"

#include <nlohmann/json.hpp>

#include "MMMConverterS2KF/report/comparison_json.h"
#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/page_sources.h"
#include "MMMConverterS2KF/report/tracks.h"

namespace mmm_converter {
namespace {

std::string FormatData(const std::vector<ReportSection>& sections, const Json* patient) {
  std::string blocks;
  if (patient != nullptr && !patient->is_null()) {
    blocks += DataBlock("patient", FormatJsonLine(*patient));
  }
  for (const ReportSection& section : sections) {
    blocks += DataBlock("heading", FormatJsonLine({{"title", section.title},
                                                   {"text", section.text},
                                                   {"verdict", section.verdict}}));
    blocks += DataBlock("figures", FormatJson(ToJson(*section.comparison)));
    Json tracks = TracksJson(*section.comparison);
    if (section.ground != nullptr && !section.ground->is_null()) {
      tracks["trials"].front()["ground"] = *section.ground;
    }
    blocks += DataBlock("tracks", FormatJsonLine(tracks));
  }
  return blocks;
}

}  // namespace

std::string FormatReport(const std::string& title, const std::vector<ReportSection>& sections,
                         const Json* patient) {
  const std::string data = FormatData(sections, patient);
  return FormatPage(
      {.title = title,
       .styles = PageStyles(),
       .content = PageContent(),
       .data = data,
       .libraries = {{SceneLibrary(), SceneLibrarySha256()}, {PlotLibrary(), PlotLibrarySha256()}},
       .script = {PageScript(), PageScriptSha256()}});
}

}  // namespace mmm_converter
