// SPDX-License-Identifier: MIT
#include "common/io/tables/qtm_tsv.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Cells = std::vector<std::string_view>;

struct QtmHead {
  double rate = kNaN;
  double frames = kNaN;
  std::vector<std::string_view> names;
  std::string_view columns;  ///< the line that names them; empty: there is none
  std::string_view row;      ///< the first one
  std::string data;          ///< DATA_INCLUDED
  bool is_of_forces = false;
};

/// Lines begin with a key; rows begin with a number or a blank cell.
QtmHead ReadHead(LineReader* lines) {
  QtmHead head;
  Cells cells;
  std::string_view line;
  for (LineReader ahead = *lines; ahead.Next(&line); *lines = ahead) {
    SplitCells(line, SeparatorOf(line), &cells);
    const std::string_view key = cells.empty() ? "" : cells[0];
    const std::string_view value = cells.size() > 1 ? cells[1] : "";
    if (std::isfinite(CellNumber(key, ' ')) || (key.empty() && cells.size() > 1)) {
      head.row = line;
      break;
    }
    if (EqualIgnoringCase(key, "FREQUENCY")) head.rate = CellNumber(value, ' ');
    head.is_of_forces |= StartsWithIgnoringCase(key, "FORCE_PLATE");
    if (EqualIgnoringCase(key, "NO_OF_FRAMES")) head.frames = CellNumber(value, ' ');
    if (EqualIgnoringCase(key, "DATA_INCLUDED")) head.data = value;
    if (EqualIgnoringCase(key, "MARKER_NAMES")) head.names.assign(cells.begin() + 1, cells.end());
    const bool names_columns =
        EqualIgnoringCase(key, "Frame") || (!head.names.empty() && key.ends_with(" X"));
    if (names_columns) head.columns = line;
  }
  while (!head.names.empty() && head.names.back().empty()) head.names.pop_back();
  return head;
}

/// How many cells a row has before the markers': those of frame and time.
int LeadingCells(const QtmHead& head, const std::string& file) {
  Cells cells;
  SplitCells(head.columns, '\t', &cells);
  if (!head.columns.empty()) {
    return static_cast<int>(std::count_if(cells.begin(), cells.end(), [](std::string_view cell) {
      return EqualIgnoringCase(cell, "Frame") || StartsWithIgnoringCase(cell, "Time");
    }));
  }
  SplitCells(head.row, SeparatorOfNumbers(head.row), &cells);
  const std::size_t needed = 3 * head.names.size();
  const bool ends_with_separator =
      !cells.empty() && cells.back().empty() && cells.size() % 3 != needed % 3;
  const std::size_t count = cells.size() - (ends_with_separator ? 1 : 0);
  if (count < needed || count > needed + 2) {
    throw Error(
        fmt::format("{}: an export of QTM with {} cells in a row for {} markers of 3 "
                    "coordinates",
                    file, cells.size(), head.names.size()));
  }
  return static_cast<int>(count - needed);
}

}  // namespace

bool LooksLikeQtmTsv(std::string_view content) {
  LineReader lines(content.substr(0, 4096));
  std::string_view line;
  const bool is_key = lines.Next(&line) && (StartsWithIgnoringCase(line, "NO_OF_FRAMES") ||
                                            StartsWithIgnoringCase(line, "NO_OF_SAMPLES"));
  return is_key && SeparatorOf(line) == '\t';
}

MarkerTable ParseQtmTsv(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  LineReader lines(content);
  const QtmHead head = ReadHead(&lines);
  if (head.names.empty() && head.is_of_forces) {
    throw Error(
        fmt::format("{}: an export of force plates by QTM, without markers; export the 3D "
                    "data, too, or the whole measurement as C3D",
                    file));
  }
  if (head.names.empty()) {
    throw Error(
        fmt::format("{}: an export of QTM without MARKER_NAMES{}; export 3D data with a "
                    "header, or as C3D",
                    file, head.data.empty() ? "" : fmt::format(" (it has {} data)", head.data)));
  }
  if (head.row.empty()) throw Error(fmt::format("{}: a QTM export without rows of data", file));
  const int leading = LeadingCells(head, file);
  MarkerColumns columns;
  columns.frame = leading == 2 ? 0 : -1;
  columns.time = leading - 1;
  for (std::size_t i = 0; i < head.names.size(); ++i) {
    const auto first = static_cast<std::size_t>(leading) + 3 * i;
    if (head.names[i].empty()) continue;
    columns.Add(head.names[i], first);
  }
  MarkerTable table = ReadMarkerRows(
      &lines, columns,
      {.name = "QTM export", .separator = SeparatorOfNumbers(head.row), .said_rate = head.rate},
      file, content.size(), warnings);
  table.unit = "mm";
  if (head.frames > 0 && head.frames < 1e9) {
    table.declared_frames = static_cast<long>(head.frames);
    if (table.declared_frames != table.num_rows) {
      Warn(warnings,
           fmt::format("NO_OF_FRAMES says {}, there are {} rows", head.frames, table.num_rows));
    }
  }
  return table;
}

}  // namespace mmm_converter
