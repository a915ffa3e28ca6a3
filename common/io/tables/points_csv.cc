// SPDX-License-Identifier: MIT
#include "common/io/tables/points_csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Cells = std::vector<std::string_view>;

constexpr std::size_t kFewestPoints = 3;
constexpr double kLeastShare = 0.7;  // of the columns; homogeneous coordinates have 3 of 4
constexpr int kMostBlankLines = 10;
constexpr std::string_view kMarks = "_.-: ";

/// What a cell of the header says of its column.
struct Coordinate {
  std::string_view name;  ///< empty: of which point stands in another row
  int axis = -1;          ///< 0 to 2; -1: it is none
  std::string_view unit;
};

bool IsUnit(std::string_view text) {
  return text == "m" || text == "mm" || text == "cm" || text == "in";
}

/// The axis that a single letter or digit names; -1: none. digits: "LASI[0]".
int AxisOf(std::string_view text, bool digits) {
  if (text.size() != 1) return -1;
  const char c = static_cast<char>(text[0] | 0x20);
  if (c >= 'x' && c <= 'z') return c - 'x';
  return digits && text[0] >= '0' && text[0] <= '2' ? text[0] - '0' : -1;
}

/// What stands in brackets at the end, which are taken off; empty: nothing does.
std::string_view TakeBrackets(std::string_view* cell) {
  for (const auto& [open, close] : {std::pair('(', ')'), std::pair('[', ']')}) {
    const std::size_t at = cell->ends_with(close) ? cell->rfind(open) : std::string_view::npos;
    if (at == std::string_view::npos) continue;
    const std::string_view inside = Trim(cell->substr(at + 1, cell->size() - at - 2));
    *cell = Trim(cell->substr(0, at));
    return inside;
  }
  return {};
}

Coordinate CoordinateOf(std::string_view cell) {
  Coordinate found;
  std::string_view rest = cell;
  std::string_view inside = TakeBrackets(&rest);
  if (IsUnit(inside)) {
    found.unit = inside;
    cell = rest;
    inside = TakeBrackets(&rest);
  }
  if (const int axis = AxisOf(inside, true); axis >= 0 && !rest.empty()) {
    return {rest, axis, found.unit};
  }
  const std::size_t bar = cell.find_last_of("_ ");
  if (bar != std::string_view::npos && found.unit.empty() && IsUnit(cell.substr(bar + 1))) {
    found.unit = cell.substr(bar + 1);
    cell = cell.substr(0, bar);
  }
  if (cell.empty()) return {};
  found.axis = AxisOf(cell.substr(cell.size() - 1), false);
  if (found.axis < 0 || cell.size() == 1) return found;
  cell.remove_suffix(1);
  if (kMarks.find(cell.back()) == std::string_view::npos) return {};
  found.name = Trim(cell.substr(0, cell.size() - 1));
  if (found.name.empty()) found.axis = -1;
  return found;
}

/// The same of the second of two rows, where axes are numbered, too: "X1".
int AxisOfRow(std::string_view cell) {
  while (cell.size() > 1 && cell.back() >= '0' && cell.back() <= '9') cell.remove_suffix(1);
  const Coordinate one = CoordinateOf(cell);
  return one.name.empty() ? one.axis : -1;
}

bool IsFrame(std::string_view cell) {
  return StartsWithIgnoringCase(cell, "frame") || EqualIgnoringCase(cell, "sample") || cell == "#";
}

bool IsTime(std::string_view cell) {
  return StartsWithIgnoringCase(cell, "time") || EqualIgnoringCase(cell, "t") ||
         EqualIgnoringCase(cell, "t (s)") || EqualIgnoringCase(cell, "t_s");
}

struct PointsHead {
  MarkerColumns columns;
  std::string_view unit;
  char separator = ',';
};

/// Columns in threes, by their coordinates; nothing where these are not most of the table.
std::optional<PointsHead> HeadOfPoints(const Cells& names, const Cells& axes, char separator) {
  PointsHead head;
  head.separator = separator;
  head.columns.frame = head.columns.time = -1;
  const bool has_two_rows = !axes.empty();
  const auto at = [&](std::size_t i) -> Coordinate {
    if (!has_two_rows) return CoordinateOf(names[i]);
    const std::string_view axis = i < axes.size() ? axes[i] : std::string_view();
    return {names[i], AxisOfRow(axis), CoordinateOf(axis).unit};
  };
  std::size_t others = 0;
  for (std::size_t i = 0; i < names.size();) {
    const Coordinate x = at(i);
    const bool may_begin = x.axis == 0 && !x.name.empty() && i + 2 < names.size();
    const Coordinate y = may_begin ? at(i + 1) : Coordinate(),
                     z = may_begin ? at(i + 2) : Coordinate();
    const auto is_same = [&](const Coordinate& one) {
      return one.name == x.name || (has_two_rows && one.name.empty());
    };
    if (may_begin && y.axis == 1 && z.axis == 2 && is_same(y) && is_same(z)) {
      head.columns.Add(x.name, i);
      if (head.unit.empty()) head.unit = x.unit;
      i += 3;
      continue;
    }
    std::string_view name = names[i];
    if (has_two_rows && name.empty() && i < axes.size()) name = axes[i];
    // The index of a data frame, which is named in a row of its own.
    const bool is_index = has_two_rows && i == 0 && name.empty();
    if (is_index) {
      head.columns.time = 0;
    } else if (head.columns.frame < 0 && IsFrame(name)) {
      head.columns.frame = static_cast<int>(i);
    } else if (head.columns.time < 0 && IsTime(name)) {
      head.columns.time = static_cast<int>(i);
    } else {
      others += name.empty() ? 0 : 1;
    }
    ++i;
  }
  const auto points = static_cast<double>(3 * head.columns.labels.size());
  const bool are_most = points >= kLeastShare * (points + static_cast<double>(others));
  if (head.columns.labels.size() < kFewestPoints || !are_most) return std::nullopt;
  return head;
}

/// lines: goes behind the header.
std::optional<PointsHead> ReadPointsHead(LineReader* lines) {
  std::string_view first, second;
  for (int i = 0; i < kMostBlankLines && lines->Next(&first) && Trim(first).empty();) ++i;
  const char separator = SeparatorOf(first);
  if (separator == ' ') return std::nullopt;
  Cells names, axes;
  SplitCells(first, separator, &names);
  if (auto head = HeadOfPoints(names, {}, separator)) return head;
  if (!lines->Next(&second)) return std::nullopt;
  SplitCells(second, separator, &axes);
  return HeadOfPoints(names, axes, separator);
}

}  // namespace

bool LooksLikePointsCsv(std::string_view content) {
  LineReader lines(content);
  return ReadPointsHead(&lines).has_value();
}

MarkerTable ParsePointsCsv(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  LineReader lines(content);
  const std::optional<PointsHead> head = ReadPointsHead(&lines);
  if (!head) throw Error(fmt::format("{}: most columns are no coordinates of points", file));
  // Indices of data frames may have names in a row of their own.
  Cells cells;
  std::string_view line;
  for (LineReader ahead = lines; ahead.Next(&line); lines = ahead) {
    SplitCells(line, head->separator, &cells);
    const bool is_row = std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
      return std::isfinite(CellNumber(cell, head->separator));
    });
    if (is_row) break;
  }
  MarkerTable table = ReadMarkerRows(&lines, head->columns,
                                     {.name = "table of points", .separator = head->separator},
                                     file, content.size(), warnings);
  table.unit = head->unit;
  return table;
}

}  // namespace mmm_converter
