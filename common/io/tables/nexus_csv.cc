// SPDX-License-Identifier: MIT
#include "common/io/tables/nexus_csv.h"

#include <fmt/core.h>

#include <algorithm>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

using Cells = std::vector<std::string_view>;

constexpr std::size_t kFirstNexusColumn = 2;  // behind frame and sub frame
constexpr std::string_view kSections[] = {"Trajectories", "Model Outputs", "Devices",
                                          "Joints",       "Segments",      "Events"};

/// The section that a line names; empty: none.
std::string_view SectionOf(std::string_view line) {
  Cells cells;
  SplitCells(line, SeparatorOf(line) == ' ' ? ',' : SeparatorOf(line), &cells);
  const bool is_alone = std::all_of(cells.begin() + 1, cells.end(),
                                    [](std::string_view cell) { return cell.empty(); });
  if (!is_alone) return {};
  const auto* const found =
      std::find_if(std::begin(kSections), std::end(kSections),
                   [&](std::string_view name) { return EqualIgnoringCase(cells[0], name); });
  return found == std::end(kSections) ? std::string_view() : *found;
}

/// The number that stands alone in a line; NaN where there is another thing.
double LoneNumber(std::string_view line) {
  Cells cells;
  SplitCells(line, SeparatorOf(line), &cells);
  return cells.empty() ? CellNumber("", ' ') : CellNumber(cells[0], ' ');
}

/// Goes to the trajectories, up to and with the line of their name.
void FindTrajectories(LineReader* lines, const std::string& file) {
  std::vector<std::string> others;
  for (std::string_view line; lines->Next(&line);) {
    if (line.size() > 1024) continue;
    const std::string_view section = SectionOf(line);
    if (section == kSections[0]) return;
    if (!section.empty() && others.size() < std::size(kSections)) others.emplace_back(section);
  }
  throw Error(
      fmt::format("{}: an export of Vicon Nexus without trajectories of markers (it has {}); "
                  "export it with \"Trajectories\" switched on, or take the trial's .c3d",
                  file, JoinNames(others, " and ")));
}

bool AreXyz(const Cells& axes, std::size_t first) {
  return first + 2 < axes.size() && EqualIgnoringCase(axes[first], "X") &&
         EqualIgnoringCase(axes[first + 1], "Y") && EqualIgnoringCase(axes[first + 2], "Z");
}

}  // namespace

bool LooksLikeNexusCsv(std::string_view content) {
  LineReader lines(content.substr(0, 4096));
  std::string_view line;
  while (lines.Next(&line) && Trim(line).empty()) {
  }
  return !SectionOf(line).empty() && lines.Next(&line) && LoneNumber(line) > 0;
}

MarkerTable ParseNexusCsv(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  LineReader lines(content);
  FindTrajectories(&lines, file);
  std::string_view rate;
  std::string_view names;
  std::string_view heads;
  std::string_view units;
  const bool is_whole =
      lines.Next(&rate) && lines.Next(&names) && lines.Next(&heads) && lines.Next(&units);
  const char separator = SeparatorOf(heads);
  Cells labels;
  Cells axes;
  Cells cells;
  SplitCells(names, separator, &labels);
  SplitCells(heads, separator, &axes);
  SplitCells(units, separator, &cells);
  if (!is_whole || axes.empty() || !EqualIgnoringCase(axes[0], "Frame")) {
    throw Error(
        fmt::format("{}:{}: behind \"Trajectories\" a rate, names, and \"Frame, Sub Frame, "
                    "X, Y, Z, ...\" were expected",
                    file, lines.number()));
  }
  MarkerColumns columns;
  columns.time = -1;
  for (std::size_t i = kFirstNexusColumn; i < labels.size(); ++i) {
    if (!labels[i].empty() && AreXyz(axes, i)) columns.Add(labels[i], i);
  }
  if (columns.labels.empty()) {
    throw Error(fmt::format("{}:{}: no trajectory has a name", file, lines.number() - 2));
  }
  MarkerTable table = ReadMarkerRows(&lines, columns,
                                     {.name = "Nexus export",
                                      .separator = separator,
                                      .ends_with_other_row = true,
                                      .said_rate = LoneNumber(rate)},
                                     file, content.size(), warnings);
  if (columns.first.front() < cells.size()) table.unit = cells[columns.first.front()];
  return table;
}

}  // namespace mmm_converter
