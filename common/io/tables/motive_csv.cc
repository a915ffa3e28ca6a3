// SPDX-License-Identifier: MIT
#include "common/io/tables/motive_csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

using Cells = std::vector<std::string_view>;

constexpr int kMostMotiveLines = 20;
constexpr std::string_view kMeasured = "Marker";
constexpr std::string_view kSolved[] = {"Bone Marker", "Rigid Body Marker", "Skeleton Marker",
                                        "Trained Markerset Marker"};

/// The rows that say what columns are.
struct MotiveHead {
  double rate = kNaN;
  std::string unit;
  Cells types, names, kinds, axes;
};

void ReadKeys(const Cells& cells, MotiveHead* head) {
  double capture_rate = kNaN;
  for (std::size_t i = 0; i + 1 < cells.size(); i += 2) {
    if (EqualIgnoringCase(cells[i], "Export Frame Rate"))
      head->rate = CellNumber(cells[i + 1], ' ');
    if (EqualIgnoringCase(cells[i], "Capture Frame Rate")) {
      capture_rate = CellNumber(cells[i + 1], ' ');
    }
    if (!EqualIgnoringCase(cells[i], "Length Units")) continue;
    const std::string unit = ToLower(cells[i + 1]);
    head->unit = unit.starts_with("milli")   ? "mm"
                 : unit.starts_with("centi") ? "cm"
                 : unit.starts_with("inch")  ? "in"
                 : unit.starts_with("met")   ? "m"
                                             : unit;
  }
  if (!(head->rate > 0)) head->rate = capture_rate;
}

bool IsOfMarkers(std::string_view type) {
  return type == kMeasured ||
         std::find(std::begin(kSolved), std::end(kSolved), type) != std::end(kSolved);
}

/// Up to the row that begins with "Frame".
MotiveHead ReadHead(LineReader* lines, char separator, const std::string& file) {
  MotiveHead head;
  std::vector<std::string_view> rows;
  Cells cells;
  std::string_view line;
  for (int i = 0; i < kMostMotiveLines && lines->Next(&line); ++i) {
    SplitCells(line, separator, &cells);
    if (i == 0) ReadKeys(cells, &head);
    if (EqualIgnoringCase(cells[0], "Frame")) {
      head.axes = cells;
      break;
    }
    if (i > 0 && !Trim(line).empty()) rows.push_back(line);
  }
  if (head.axes.empty()) {
    throw Error(
        fmt::format("{}: an export of Motive without the line Frame, Time, X, Y, Z, ...", file));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SplitCells(rows[i], separator, &cells);
    const bool says_type = cells.size() > 1 && EqualIgnoringCase(cells[1], "Type");
    const bool says_name = cells.size() > 1 && EqualIgnoringCase(cells[1], "Name");
    const bool is_first = head.types.empty() && !says_name;
    const bool is_second = !head.types.empty() && head.names.empty();
    if (says_type || is_first) {
      head.types = cells;
    } else if (says_name || is_second) {
      head.names = cells;
    }
    if (i + 1 == rows.size()) head.kinds = cells;
  }
  return head;
}

bool IsPosition(const MotiveHead& head, std::size_t first) {
  const auto is = [&](const Cells& cells, std::size_t i, std::string_view text) {
    return i < cells.size() && EqualIgnoringCase(cells[i], text);
  };
  return is(head.kinds, first, "Position") && is(head.axes, first, "X") &&
         is(head.axes, first + 1, "Y") && is(head.axes, first + 2, "Z");
}

std::string LabelOf(std::string_view name) {
  constexpr std::string_view kUnlabelled = "Unlabeled";
  const std::size_t colon = name.rfind(':');
  const std::string_view bare = colon == std::string_view::npos ? name : name.substr(colon + 1);
  if (!StartsWithIgnoringCase(bare, kUnlabelled)) return std::string(name);
  return fmt::format("*{}", Trim(Trim(bare).substr(kUnlabelled.size())));
}

/// The markers of that type, or of the solver's types.
MarkerColumns ColumnsOf(const MotiveHead& head, bool measured) {
  MarkerColumns columns;
  columns.time = head.axes.size() > 1 && StartsWithIgnoringCase(head.axes[1], "Time") ? 1 : -1;
  for (std::size_t i = 1; i < std::min(head.types.size(), head.names.size()); ++i) {
    const bool is_wanted = measured ? head.types[i] == kMeasured
                                    : IsOfMarkers(head.types[i]) && head.types[i] != kMeasured;
    if (is_wanted && !head.names[i].empty() && IsPosition(head, i)) {
      columns.Add(LabelOf(head.names[i]), i);
    }
  }
  return columns;
}

[[noreturn]] void ThrowNoMarkers(const MotiveHead& head, const std::string& file) {
  std::set<std::string> types;
  for (std::size_t i = 2; i < head.types.size() && types.size() < 8; ++i) {
    if (!head.types[i].empty()) types.emplace(head.types[i]);
  }
  throw Error(
      fmt::format("{}: an export of Motive without positions of markers (it has: {}); export "
                  "it with \"Markers\" switched on, or as C3D or TRC",
                  file, types.empty() ? "nothing" : FirstNames({types.begin(), types.end()})));
}

}  // namespace

bool LooksLikeMotiveCsv(std::string_view content) {
  LineReader lines(content.substr(0, 4096));
  std::string_view line;
  return lines.Next(&line) && StartsWithIgnoringCase(line, "Format Version") &&
         SeparatorOf(line) != ' ';
}

MarkerTable ParseMotiveCsv(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  LineReader lines(content);
  std::string_view first_line;
  LineReader(content).Next(&first_line);
  const char separator = SeparatorOf(first_line);
  const MotiveHead head = ReadHead(&lines, separator, file);
  MarkerColumns columns = ColumnsOf(head, true);
  if (columns.labels.empty()) {
    columns = ColumnsOf(head, false);
    if (columns.labels.empty()) ThrowNoMarkers(head, file);
    Warn(warnings,
         "holds markers only as Motive's solver has them, which are less than was "
         "measured; export \"Markers\" too");
  }
  MarkerTable table = ReadMarkerRows(
      &lines, columns, {.name = "Motive export", .separator = separator, .said_rate = head.rate},
      file, content.size(), warnings);
  table.unit = head.unit;
  return table;
}

}  // namespace mmm_converter
