// SPDX-License-Identifier: MIT
#include "common/io/tables/trc_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

#include "common/support/error.h"
#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr double kFarAway = 1e6;              // some systems write 9999999 for a missing marker
constexpr std::size_t kFirstLabelColumn = 2;  // behind frame and time

/// Lines without their ends, one after the other.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  bool Next(std::string_view* line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    *line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line->ends_with('\r')) line->remove_suffix(1);
    ++number_;
    return true;
  }
  int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Cells of a line by position, blanks around them cut off. A blank cell stays a cell.
void Split(std::string_view line, char separator, std::vector<std::string_view>* cells) {
  cells->clear();
  while (true) {
    const std::size_t end = line.find(separator);
    cells->push_back(Trim(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

/// NaN for what is not a number. A decimal comma is understood where commas do not separate.
double Number(std::string_view cell, char separator) {
  if (const auto number = ParseDouble(cell)) return *number;
  if (separator == ',' || cell.find(',') == std::string_view::npos) return kNaN;
  std::string with_point(cell);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return ParseDouble(with_point).value_or(kNaN);
}

char SeparatorOf(std::string_view line) {
  for (const char separator : {'\t', ';', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return '\t';
}

bool StartsWithIgnoringCase(std::string_view text, std::string_view start) {
  return EqualIgnoringCase(Trim(text).substr(0, start.size()), start);
}

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
  Split(keys_line, separator, &keys);
  Split(values_line, SeparatorOf(values_line), &values);
  double camera_rate = kNaN;
  for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    if (EqualIgnoringCase(keys[i], "DataRate")) header.rate = Number(values[i], separator);
    if (EqualIgnoringCase(keys[i], "CameraRate")) camera_rate = Number(values[i], separator);
    if (EqualIgnoringCase(keys[i], "NumFrames")) header.frames = Number(values[i], separator);
    if (EqualIgnoringCase(keys[i], "NumMarkers")) header.markers = Number(values[i], separator);
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

/// Names and where their x stands. Names belong to every third column; some files list them
/// densely.
struct Columns {
  std::vector<std::string> labels;
  std::vector<std::size_t> first;
};

Columns ReadLabels(const std::vector<std::string_view>& cells) {
  std::size_t in_place = 0;
  std::vector<std::size_t> named;
  for (std::size_t i = kFirstLabelColumn; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    named.push_back(i);
    in_place += (i - kFirstLabelColumn) % 3 == 0;
  }
  const bool dense = in_place < named.size();
  Columns columns;
  std::set<std::string> seen;
  for (std::size_t k = 0; k < named.size(); ++k) {
    std::string label(cells[named[k]]);
    if (!seen.insert(label).second) label = fmt::format("*{}#{}", label, k + 1);
    columns.labels.push_back(std::move(label));
    columns.first.push_back(dense ? kFirstLabelColumn + 3 * k : named[k]);
  }
  return columns;
}

/// The even rate of the time column, if it has one.
std::optional<double> RateOf(const std::vector<double>& times) {
  if (times.size() < 2 || !(times.back() > times.front())) return std::nullopt;
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double even = times.front() + step * static_cast<double>(k);
    if (!(std::abs(times[k] - even) <= 0.5 * step)) return std::nullopt;
  }
  return 1 / step;
}

struct Rows {
  std::vector<double> coordinates;
  std::vector<double> times;
  long first_frame = 1;
  int unreadable_cells = 0;
};

void AppendRow(const std::vector<std::string_view>& cells, const Columns& columns, char separator,
               Rows* rows) {
  for (const std::size_t first : columns.first) {
    double p[3] = {kNaN, kNaN, kNaN};
    for (std::size_t j = 0; j < 3 && first + j < cells.size(); ++j) {
      p[j] = Number(cells[first + j], separator);
      if (!cells[first + j].empty() && std::isnan(p[j]) &&
          !EqualIgnoringCase(cells[first + j], "nan")) {
        ++rows->unreadable_cells;
      }
    }
    const bool far =
        !(std::abs(p[0]) <= kFarAway && std::abs(p[1]) <= kFarAway && std::abs(p[2]) <= kFarAway);
    if (far || (p[0] == 0 && p[1] == 0 && p[2] == 0)) p[0] = p[1] = p[2] = kNaN;
    rows->coordinates.insert(rows->coordinates.end(), p, p + 3);
  }
}

/// A file with all its cells has at most one number a byte: short rows must not blow up memory.
Rows ReadRows(LineReader* lines, const Columns& columns, char separator, const std::string& file,
              std::size_t file_bytes) {
  const std::size_t max_coordinates = 1000000 + 2 * file_bytes;
  Rows rows;
  std::vector<std::string_view> cells;
  for (std::string_view line; lines->Next(&line);) {
    Split(line, separator, &cells);
    const double frame = Number(cells[0], separator);
    if (!std::isfinite(frame)) continue;  // X1 Y1 Z1, blank, or a note
    if (rows.times.empty() && std::abs(frame) < 1e9) rows.first_frame = std::lround(frame);
    rows.times.push_back(cells.size() > 1 ? Number(cells[1], separator) : kNaN);
    if (rows.coordinates.size() + 3 * columns.labels.size() > max_coordinates) {
      throw Error(fmt::format("{}:{}: rows are too short for {} labels", file, lines->number(),
                              columns.labels.size()));
    }
    AppendRow(cells, columns, separator, &rows);
  }
  if (rows.times.empty()) throw Error(fmt::format("{}: a TRC file without rows of data", file));
  return rows;
}

double ChooseRate(const TrcHeader& header, const Rows& rows, const std::string& file,
                  Warnings* warnings) {
  const std::optional<double> by_times = RateOf(rows.times);
  const bool said = std::isfinite(header.rate) && header.rate > 0;
  if (!said && !by_times) {
    throw Error(
        fmt::format("{}: gives no frame rate: neither DataRate nor an even time column", file));
  }
  if (!said) return *by_times;
  // Times are rounded, over a whole file to far less than that.
  if (!by_times || std::abs(*by_times / header.rate - 1) < 0.01) return header.rate;
  Warn(warnings, fmt::format("DataRate says {} Hz, the time column {:.6g} Hz; the latter is used",
                             header.rate, *by_times));
  return *by_times;
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

TrcFile ParseTrc(std::string_view content, const std::string& file, Warnings* warnings) {
  const WarningContext context(warnings, file);
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  LineReader lines(content);
  TrcHeader header;
  std::string_view line;
  std::string_view previous;
  bool found = false;
  for (int i = 0; i < 20 && !found && lines.Next(&line); ++i) {
    if (previous.find("DataRate") != std::string_view::npos) header = ReadHeader(previous, line);
    found = StartsWithIgnoringCase(line, "Frame#");
    previous = line;
  }
  if (!found)
    throw Error(fmt::format("{}: a TRC file without the line Frame#, Time, labels", file));
  const char separator = SeparatorOf(line);
  std::vector<std::string_view> cells;
  Split(line, separator, &cells);
  const Columns columns = ReadLabels(cells);
  if (columns.labels.empty()) {
    throw Error(fmt::format("{}:{}: a TRC file without marker labels", file, lines.number()));
  }
  const Rows rows = ReadRows(&lines, columns, separator, file, content.size());

  TrcFile trc;
  trc.unit = header.unit;
  trc.first_frame = rows.first_frame;
  const double first_time = std::isfinite(rows.times.front()) ? rows.times.front() : 0;
  const double rate = ChooseRate(header, rows, file, warnings);
  const int frames = static_cast<int>(rows.times.size());
  trc.markers = MarkerSequence(columns.labels, frames, rate, first_time);
  std::copy(rows.coordinates.begin(), rows.coordinates.end(), trc.markers.frame(0).data());
  if (std::isfinite(header.frames) && header.frames != frames) {
    Warn(warnings, fmt::format("NumFrames says {}, there are {} rows", header.frames, frames));
  }
  if (header.frames > 0 && header.frames < 1e9) {
    trc.declared_frames = static_cast<long>(header.frames);
  }
  if (std::isfinite(header.markers) && header.markers != trc.markers.num_labels()) {
    Warn(warnings, fmt::format("NumMarkers says {}, there are {} labels", header.markers,
                               trc.markers.num_labels()));
  }
  if (rows.unreadable_cells > 0) {
    Warn(warnings, fmt::format("{} cells are not numbers; read as missing", rows.unreadable_cells));
  }
  return trc;
}

}  // namespace mmm_converter
