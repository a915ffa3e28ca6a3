// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kFirstLabelColumn = 2;  // behind frame and time
constexpr int kMostHeaderLines = 20;

/// What the keys in line 2 and the values in line 3 say; NaN where they don't.
struct TrcHeader {
  double rate = kNaN;
  double frames = kNaN;
  double markers = kNaN;
  std::string unit;
};

TrcHeader ReadHeader(std::string_view keys_line, std::string_view values_line) {
  TrcHeader header;
  const char separator = SeparatorOf(keys_line);
  std::vector<std::string_view> keys;
  std::vector<std::string_view> values;
  SplitCells(keys_line, separator, &keys);
  SplitCells(values_line, SeparatorOf(values_line), &values);
  double camera_rate = kNaN;
  for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    const double number = CellNumber(values[i], separator);
    if (EqualIgnoringCase(keys[i], "DataRate")) header.rate = number;
    if (EqualIgnoringCase(keys[i], "CameraRate")) camera_rate = number;
    if (EqualIgnoringCase(keys[i], "NumFrames")) header.frames = number;
    if (EqualIgnoringCase(keys[i], "NumMarkers")) header.markers = number;
    if (EqualIgnoringCase(keys[i], "Units")) header.unit = values[i];
  }
  if (!(header.rate > 0)) header.rate = camera_rate;
  if (header.unit.empty() || ParseDouble(header.unit)) {  // the unit may stand in another column
    header.unit.clear();
    for (const std::string_view value : values) {
      if (!value.empty() && !ParseDouble(value)) header.unit = value;
    }
  }
  return header;
}

/// "LASI_X" is LASI, as are "LASI_Y" and "LASI_Z"; empty: it does not name that coordinate.
std::string_view NameOfCoordinate(std::string_view cell, char coordinate) {
  constexpr std::string_view kSeparators = "_.-: ";
  if (cell.size() < 3 || (cell.back() | 0x20) != coordinate) return {};
  cell.remove_suffix(1);
  if (kSeparators.find(cell.back()) == std::string_view::npos) return {};
  return cell.substr(0, cell.size() - 1);
}

/// Names that stand over each of their coordinates; none, where they do not.
MarkerColumns ReadNamesOfCoordinates(const std::vector<std::string_view>& cells) {
  MarkerColumns columns;
  for (std::size_t i = kFirstLabelColumn; i < cells.size(); i += 3) {
    if (cells[i].empty()) continue;
    const std::string_view name = NameOfCoordinate(cells[i], 'x');
    const bool is_whole = i + 2 < cells.size() && !name.empty() &&
                          NameOfCoordinate(cells[i + 1], 'y') == name &&
                          NameOfCoordinate(cells[i + 2], 'z') == name;
    if (!is_whole) return {};
    columns.Add(name, i);
  }
  return columns;
}

/// Names and where their x stands. Names belong to every third column; some files list them
/// densely.
MarkerColumns ReadLabels(const std::vector<std::string_view>& cells) {
  MarkerColumns of_coordinates = ReadNamesOfCoordinates(cells);
  if (!of_coordinates.labels.empty()) return of_coordinates;
  std::size_t in_place = 0;
  std::vector<std::size_t> named;
  for (std::size_t i = kFirstLabelColumn; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    named.push_back(i);
    in_place += (i - kFirstLabelColumn) % 3 == 0;
  }
  const bool dense = in_place < named.size();
  MarkerColumns columns;
  for (std::size_t k = 0; k < named.size(); ++k) {
    columns.Add(cells[named[k]], dense ? kFirstLabelColumn + 3 * k : named[k]);
  }
  return columns;
}

/// The next line of numbers; empty: there is none.
std::string_view NextRow(LineReader lines) {
  std::vector<std::string_view> cells;
  for (std::string_view line; lines.Next(&line);) {
    const char separator = SeparatorOfNumbers(line);
    SplitCells(line, separator, &cells);
    if (std::isfinite(CellNumber(cells.empty() ? "" : cells[0], separator))) return line;
  }
  return {};
}

/// As many markers as a row has room for.
MarkerColumns NumberedColumns(std::string_view row) {
  std::vector<std::string_view> cells;
  SplitCells(row, SeparatorOfNumbers(row), &cells);
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  MarkerColumns columns;
  for (std::size_t first = kFirstLabelColumn; first < cells.size(); first += 3) {
    columns.Add(fmt::format("*{}", columns.labels.size() + 1), first);
  }
  return columns;
}

/// Reads up to the line of labels; false: there is none, and nothing was read but what stands
/// before the rows.
bool ReadHead(LineReader* lines, TrcHeader* header, std::string_view* labels) {
  std::string_view line;
  std::string_view previous;
  for (int i = 0; i < kMostHeaderLines && lines->Next(&line); ++i) {
    if (previous.find("DataRate") != std::string_view::npos) *header = ReadHeader(previous, line);
    if (StartsWithIgnoringCase(line, "Frame#")) {
      *labels = line;
      return true;
    }
    previous = line;
  }
  return false;
}

/// What the header counts, and what is there.
void CompareCounts(const TrcHeader& header, MarkerTable* trc, Warnings* warnings) {
  if (std::isfinite(header.frames) && header.frames != static_cast<double>(trc->num_rows)) {
    Warn(warnings,
         fmt::format("NumFrames says {}, there are {} rows", header.frames, trc->num_rows));
  }
  if (header.frames > 0 && header.frames < 1e9) {
    trc->declared_frames = static_cast<long>(header.frames);
  }
  if (std::isfinite(header.markers) && header.markers != trc->markers.num_labels()) {
    Warn(warnings, fmt::format("NumMarkers says {}, there are {} labels", header.markers,
                               trc->markers.num_labels()));
  }
}

}  // namespace

bool LooksLikeTrc(std::string_view content) {
  LineReader lines(content.substr(0, 1 << 16));
  std::string_view line;
  for (int i = 0; i < 10 && lines.Next(&line); ++i) {
    if (StartsWithIgnoringCase(line, "PathFileType") || StartsWithIgnoringCase(line, "Frame#")) {
      return true;
    }
  }
  return false;
}

MarkerTable ParseTrc(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  LineReader lines(content);
  TrcHeader header;
  std::string_view labels;
  const bool has_labels = ReadHead(&lines, &header, &labels);
  if (!has_labels) {
    constexpr int kLinesOfHeader = 3;
    lines = LineReader(content);
    for (int i = 0; i < kLinesOfHeader && lines.Next(&labels);) ++i;
  }
  const std::string_view row = NextRow(lines);
  std::vector<std::string_view> cells;
  if (has_labels) SplitCells(labels, SeparatorOf(labels), &cells);
  MarkerColumns columns = ReadLabels(cells);
  if (columns.labels.empty()) {
    columns = NumberedColumns(row);
    if (!columns.labels.empty()) {
      Warn(warnings,
           fmt::format("no marker has a label; they are called *1 to *{}", columns.labels.size()));
    }
  }
  if (columns.labels.empty()) {
    throw Error(fmt::format("{}:{}: a TRC file without {}", file, lines.number(),
                            row.empty() ? "rows of data" : "columns of markers"));
  }
  MarkerTable trc = ReadMarkerRows(
      &lines, columns,
      {.name = "TRC file", .separator = SeparatorOfNumbers(row), .said_rate = header.rate}, file,
      content.size(), warnings);
  trc.unit = header.unit;
  CompareCounts(header, &trc, warnings);
  return trc;
}

}  // namespace mmm_converter
