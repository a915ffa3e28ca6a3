// SPDX-License-Identifier: MIT
#include "tests/support/strict_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <stdexcept>

namespace mmm_converter::testing {
namespace {

using Cells = std::vector<std::string>;

void Require(bool holds, std::size_t line, const std::string& what) {
  if (!holds) throw std::runtime_error("line " + std::to_string(line) + ": " + what);
}

Cells Split(std::string_view text, char separator) {
  Cells cells(1);
  for (const char c : text) {
    if (c == separator) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

// Every line ended by one line feed.
Cells Lines(std::string_view text) {
  Cells lines = Split(text, '\n');
  Require(lines.size() > 1 && lines.back().empty(), lines.size(), "the last line has no end");
  lines.pop_back();
  Require(text.find('\r') == std::string_view::npos, 0, "a carriage return");
  return lines;
}

double Number(const std::string& cell, std::size_t line) {
  Require(!cell.empty() && cell.find_first_not_of("+-.0123456789e") == std::string::npos, line,
          "not a number: \"" + cell + "\"");
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  Require(*end == '\0' && std::isfinite(number), line, "not a number: \"" + cell + "\"");
  return number;
}

long Whole(const std::string& cell, std::size_t line) {
  const double number = Number(cell, line);
  Require(number == std::floor(number), line, "not a whole number: \"" + cell + "\"");
  return static_cast<long>(number);
}

void RequireWords(const Cells& names, std::size_t line) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    Require(!name.empty() && name.find_first_of(" \t\v\f") == std::string::npos, line,
            "not one word: \"" + name + "\"");
    Require(seen.insert(name).second, line, "twice: " + name);
  }
}

// The cells of a line that a tab ends.
Cells TabEnded(const std::string& line, std::size_t number) {
  Cells cells = Split(line, '\t');
  Require(cells.back().empty(), number, "no tab at the end");
  cells.pop_back();
  return cells;
}

// Lines 4 and 5.
Cells TrcLabels(const Cells& lines, long num_markers) {
  const Cells names = TabEnded(lines[3], 4);
  const Cells axes = TabEnded(lines[4], 5);
  Require(names.size() == 2 + 3 * static_cast<std::size_t>(num_markers), 4, "not NumMarkers");
  Require(axes.size() == names.size(), 5, "not NumMarkers");
  Require(names[0] == "Frame#" && names[1] == "Time", 4, "not Frame#, Time");
  Require(axes[0].empty() && axes[1].empty(), 5, "a name over the frames or times");
  Cells labels;
  for (std::size_t i = 2; i < names.size(); ++i) {
    const std::size_t axis = (i - 2) % 3;
    if (axis == 0) labels.push_back(names[i]);
    Require(axis == 0 || names[i].empty(), 4, "a label that is not over an X");
    Require(axes[i] == "XYZ"[axis] + std::to_string(labels.size()), 5, axes[i]);
  }
  RequireWords(labels, 4);
  return labels;
}

Eigen::Matrix3Xd TrcMarkers(const Cells& cells, std::size_t line) {
  const std::size_t count = (cells.size() - 2) / 3;
  Eigen::Matrix3Xd markers(3, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Cells point(cells.begin() + 2 + 3 * static_cast<long>(i),
                      cells.begin() + 5 + 3 * static_cast<long>(i));
    const long empty = std::count(point.begin(), point.end(), "");
    Require(empty == 0 || empty == 3, line, "half a marker");
    for (int axis = 0; axis < 3; ++axis) {
      markers(axis, static_cast<long>(i)) =
          empty > 0 ? std::numeric_limits<double>::quiet_NaN() : Number(point[axis], line);
    }
  }
  return markers;
}

StrictTable ReadRows(const Cells& lines, std::size_t first, char separator, bool may_be_empty) {
  StrictTable table;
  Require(lines.size() > first, first, "no line of columns");
  table.columns = Split(lines[first], separator);
  RequireWords(table.columns, first + 1);
  for (std::size_t i = first + 1; i < lines.size(); ++i) {
    const Cells cells = Split(lines[i], separator);
    Require(cells.size() == table.columns.size(), i + 1, "not as many cells as columns");
    table.rows.emplace_back();
    for (const std::string& cell : cells) {
      table.rows.back().push_back(may_be_empty && cell.empty()
                                      ? std::numeric_limits<double>::quiet_NaN()
                                      : Number(cell, i + 1));
    }
  }
  return table;
}

}  // namespace

Eigen::Vector3d StrictTrc::At(std::size_t frame, const std::string& label) const {
  const auto found = std::find(labels.begin(), labels.end(), label);
  if (found == labels.end()) throw std::runtime_error("no label " + label);
  return markers.at(frame).col(found - labels.begin());
}

StrictTrc ReadStrictTrc(std::string_view text) {
  const Cells lines = Lines(text);
  Require(lines.size() >= 6, lines.size(), "no header");
  const Cells first = Split(lines[0], '\t');
  Require(first.size() == 4 && first[0] == "PathFileType" && first[1] == "4" &&
              first[2] == "(X/Y/Z)" && !first[3].empty(),
          1, lines[0]);
  Require(
      Split(lines[1], '\t') == Cells{"DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units",
                                     "OrigDataRate", "OrigDataStartFrame", "OrigNumFrames"},
      2, lines[1]);
  const Cells values = Split(lines[2], '\t');
  Require(values.size() == 8 && values[4] == "mm", 3, lines[2]);
  StrictTrc trc;
  trc.rate = Number(values[0], 3);
  const double original_rate = Number(values[5], 3);
  Require(trc.rate > 0 && Number(values[1], 3) > 0 && original_rate > 0, 3, "a rate");
  trc.labels = TrcLabels(lines, Whole(values[3], 3));
  Require(lines[5].empty(), 6, "not blank");
  const std::size_t frames = lines.size() - 6;
  Require(Whole(values[2], 3) == static_cast<long>(frames), 3, "not NumFrames");
  Require(Whole(values[7], 3) == static_cast<long>(frames), 3, "not OrigNumFrames");
  for (std::size_t k = 0; k < frames; ++k) {
    const std::size_t line = k + 7;
    const Cells cells = TabEnded(lines[k + 6], line);
    Require(cells.size() == 2 + 3 * trc.labels.size(), line, "not NumMarkers");
    trc.numbers.push_back(Whole(cells[0], line));
    Require(trc.numbers[k] == Whole(values[6], 3) + static_cast<long>(k), line, "frame number");
    trc.times.push_back(Number(cells[1], line));
    const double expected = trc.times[0] + static_cast<double>(k) / trc.rate;
    // Times and the rate have nine decimals.
    Require(std::abs(trc.times[k] - expected) < 2e-9 * static_cast<double>(k + 1), line, "time");
    trc.markers.push_back(TrcMarkers(cells, line));
  }
  return trc;
}

double StrictTable::At(std::size_t row, const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) throw std::runtime_error("no column " + column);
  return rows.at(row)[static_cast<std::size_t>(found - columns.begin())];
}

bool StrictTable::Has(const std::string& column) const {
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

StrictTable ReadStrictMot(std::string_view text) {
  const Cells lines = Lines(text);
  const auto end =
      static_cast<std::size_t>(std::find(lines.begin(), lines.end(), "endheader") - lines.begin());
  Require(end < lines.size() && !lines[0].empty(), end, "no name or no endheader");
  std::map<std::string, std::string> keys;
  for (std::size_t i = 1; i < end; ++i) {
    const std::size_t equals = lines[i].find('=');
    if (equals == std::string::npos) continue;  // a remark
    const std::string key = lines[i].substr(0, equals);
    Require(keys.emplace(key, lines[i].substr(equals + 1)).second, i + 1, "twice: " + key);
  }
  StrictTable table = ReadRows(lines, end + 1, '\t', false);
  Require(keys["version"] == "1", end, "version");
  Require(keys["inDegrees"] == "yes" || keys["inDegrees"] == "no", end, "inDegrees");
  Require(keys["nRows"] == std::to_string(table.rows.size()), end, "nRows");
  Require(keys["nColumns"] == std::to_string(table.columns.size()), end, "nColumns");
  Require(table.columns.front() == "time", end + 2, "time is not first");
  for (std::size_t k = 1; k < table.rows.size(); ++k) {
    Require(table.rows[k][0] > table.rows[k - 1][0], end + 3 + k, "time runs backwards");
  }
  table.keys = std::move(keys);
  return table;
}

StrictTable ReadStrictCsv(std::string_view text) { return ReadRows(Lines(text), 0, ',', true); }

}  // namespace mmm_converter::testing
