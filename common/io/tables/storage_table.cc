// SPDX-License-Identifier: MIT
#include "common/io/tables/storage_table.h"

#include <fmt/format.h>

#include "common/io/tables/table_text.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

bool IsEndOfHeader(std::string_view line) {
  std::vector<std::string_view> cells;
  SplitCells(line, ' ', &cells);
  return !cells.empty() && EqualIgnoringCase(cells[0], "endheader");
}

bool SkipHeader(LineReader* lines) {
  std::string_view line;
  while (lines->Next(&line)) {
    if (IsEndOfHeader(line)) return true;
  }
  return false;
}

/// Names without cells that a tab at the end makes.
std::vector<std::string> NamesOf(std::string_view line) {
  std::vector<std::string_view> cells;
  SplitCells(line, ' ', &cells);
  return {cells.begin(), cells.end()};
}

}  // namespace

StorageTable ParseStorage(std::string_view content, const std::string& file) {
  LineReader lines(content);
  if (!SkipHeader(&lines)) {
    throw Error(fmt::format("{}: has no line \"endheader\", as OpenSim's .mot files have", file));
  }
  StorageTable table;
  std::string_view line;
  while (table.columns.empty() && lines.Next(&line)) {
    if (!SaysNothing(line)) table.columns = NamesOf(line);
  }
  if (table.columns.empty() || !EqualIgnoringCase(table.columns[0], "time")) {
    throw Error(
        fmt::format("{}:{}: the line of names does not start with \"time\"", file, lines.number()));
  }
  std::vector<double> numbers;
  std::vector<std::string_view> cells;
  while (lines.Next(&line)) {
    SplitCells(line, ' ', &cells);
    if (cells.size() == 1 && cells[0].empty()) continue;
    if (cells.size() != table.columns.size()) {
      throw Error(fmt::format("{}:{}: {} numbers, but {} columns have names", file, lines.number(),
                              cells.size(), table.columns.size()));
    }
    for (const std::string_view cell : cells) numbers.push_back(CellNumber(cell, ' '));
  }
  if (numbers.empty()) throw Error(file + ": has no row of numbers");
  const auto columns = static_cast<Eigen::Index>(table.columns.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  table.rows = Eigen::Map<const RowMajor>(
      numbers.data(), static_cast<Eigen::Index>(numbers.size()) / columns, columns);
  return table;
}

}  // namespace mmm_converter
