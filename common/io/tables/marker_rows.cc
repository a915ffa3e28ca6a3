// SPDX-License-Identifier: MIT
#include "common/io/tables/marker_rows.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/io/tables/row_times.h"
#include "common/support/error.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kFarAway = 1e6;  // some systems write 9999999 for a missing marker

struct Rows {
  std::vector<double> coordinates;
  RowTimes times;
  int decimals = 0;  // of the times
  long unreadable_cells = 0;
  long short_rows = 0;
};

int DecimalsOf(std::string_view number) {
  const std::size_t point = number.find_first_of(".,");
  if (point == std::string_view::npos) return 0;
  const std::size_t end = number.find_first_not_of("0123456789", point + 1);
  return end == std::string_view::npos ? static_cast<int>(number.size() - point - 1) : 15;
}

double NumberAt(const std::vector<std::string_view>& cells, int column, char separator) {
  const auto at = static_cast<std::size_t>(column);
  return column >= 0 && at < cells.size() ? CellNumber(cells[at], separator) : kNaN;
}

void AppendTimes(const std::vector<std::string_view>& cells, const MarkerColumns& columns,
                 char separator, Rows* rows) {
  rows->times.frames.push_back(NumberAt(cells, columns.frame, separator));
  const double time = NumberAt(cells, columns.time, separator);
  rows->times.times.push_back(std::isfinite(time) ? time : kNaN);
  if (std::isfinite(time)) {
    rows->decimals =
        std::max(rows->decimals, DecimalsOf(cells[static_cast<std::size_t>(columns.time)]));
  }
}

void AppendMarkers(const std::vector<std::string_view>& cells, const MarkerColumns& columns,
                   char separator, Rows* rows) {
  // Where blanks separate, cells behind a missing one are of another column than they seem.
  const bool is_cut =
      separator == ' ' && !columns.first.empty() && cells.size() != columns.first.back() + 3;
  rows->short_rows += is_cut;
  for (const std::size_t first : columns.first) {
    double p[3] = {kNaN, kNaN, kNaN};
    for (std::size_t j = 0; j < 3 && first + j < cells.size() && !is_cut; ++j) {
      p[j] = CellNumber(cells[first + j], separator);
      rows->unreadable_cells += std::isnan(p[j]) && !SaysNothing(cells[first + j]);
    }
    const bool far =
        !(std::abs(p[0]) <= kFarAway && std::abs(p[1]) <= kFarAway && std::abs(p[2]) <= kFarAway);
    if (far || (p[0] == 0 && p[1] == 0 && p[2] == 0)) p[0] = p[1] = p[2] = kNaN;
    rows->coordinates.insert(rows->coordinates.end(), p, p + 3);
  }
}

/// A file with all its cells has at most one number a byte: short rows, and frames that are
/// missing, must not blow up memory.
double MostCoordinates(std::size_t file_bytes) { return 1e6 + 2 * static_cast<double>(file_bytes); }

Rows ReadRows(LineReader* lines, const MarkerColumns& columns, const MarkerRowsFormat& format,
              const std::string& file, double most_coordinates) {
  Rows rows;
  std::vector<std::string_view> cells;
  const std::size_t per_row = 3 * columns.labels.size();
  for (std::string_view line; lines->Next(&line);) {
    SplitCells(line, format.separator, &cells);
    if (!std::isfinite(NumberAt(cells, std::max(columns.frame, 0), format.separator)) &&
        (columns.frame >= 0 || cells.size() < per_row)) {
      if (format.ends_with_other_row && !rows.times.times.empty()) break;
      continue;  // X1 Y1 Z1, blank, or a note
    }
    if (static_cast<double>(rows.coordinates.size() + per_row) > most_coordinates) {
      throw Error(fmt::format("{}:{}: rows are too short for {} labels", file, lines->number(),
                              columns.labels.size()));
    }
    AppendTimes(cells, columns, format.separator, &rows);
    AppendMarkers(cells, columns, format.separator, &rows);
  }
  if (rows.times.times.empty()) {
    throw Error(fmt::format("{}: a {} without rows of data", file, format.name));
  }
  rows.times.resolution = std::pow(10.0, -rows.decimals);
  return rows;
}

void CheckPlaces(const RowPlaces& placed, std::size_t labels, double most_coordinates,
                 const std::string& file) {
  const auto places = static_cast<double>(placed.num_places);
  if (places * 3 * static_cast<double>(labels) <= most_coordinates &&
      places <= std::numeric_limits<int>::max()) {
    return;
  }
  throw Error(
      fmt::format("{}: its {} rows reach over {:.6g} frames of {:.6g} Hz, by times or frame "
                  "numbers that skip; mend these, or cut the file there",
                  file, placed.places.size(), places, placed.rate));
}

}  // namespace

void MarkerColumns::Add(std::string_view label, std::size_t first_cell) {
  std::string name(label);
  if (!seen_.insert(name).second) name = fmt::format("*{}#{}", name, labels.size() + 1);
  labels.push_back(std::move(name));
  first.push_back(first_cell);
}

MarkerTable ReadMarkerRows(LineReader* lines, const MarkerColumns& columns,
                           const MarkerRowsFormat& format, const std::string& file,
                           std::size_t file_bytes, Warnings* warnings) {
  const double most = MostCoordinates(file_bytes);
  Rows rows = ReadRows(lines, columns, format, file, most);
  const RowPlaces placed = PlaceRows(std::move(rows.times), format.said_rate, warnings);
  CheckPlaces(placed, columns.labels.size(), most, file);
  MarkerTable table;
  table.first_frame = placed.first_frame;
  table.num_rows = static_cast<long>(placed.places.size());
  table.has_rate = placed.rate > 0;
  table.markers = MarkerSequence(columns.labels, static_cast<int>(placed.num_places),
                                 table.has_rate ? placed.rate : 1, placed.first_time);
  const auto per_row = static_cast<std::ptrdiff_t>(3 * columns.labels.size());
  for (std::size_t k = 0; k < placed.places.size(); ++k) {
    if (placed.places[k] < 0) continue;
    std::copy_n(rows.coordinates.begin() + static_cast<std::ptrdiff_t>(k) * per_row, per_row,
                table.markers.frame(static_cast<int>(placed.places[k])).data());
  }
  if (rows.unreadable_cells > 0) {
    Warn(warnings, fmt::format("{} cells are not numbers; read as missing", rows.unreadable_cells));
  }
  if (rows.short_rows > 0) {
    Warn(warnings, fmt::format("{} rows have another number of cells than there are columns, and "
                               "blanks between them do not tell which are missing: no marker is "
                               "read there",
                               rows.short_rows));
  }
  return table;
}

}  // namespace mmm_converter
