// SPDX-License-Identifier: MIT
#include "common/io/tables/table_text.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/support/text.h"
#include "common/support/units.h"

namespace mmm_converter {
namespace {

constexpr std::string_view kBlanks = " \t\f\v\r";

void SplitAtBlanks(std::string_view line, std::vector<std::string_view>* cells) {
  for (;;) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    cells->push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

/// Where the cell at the begin of the line ends. What stands between quotation marks belongs to it,
/// but not in tables that tabs separate, where nobody writes them so.
std::size_t EndOfCell(std::string_view line, char separator) {
  if (separator != '\t' && line.starts_with('"')) {
    const std::size_t closing = line.find('"', 1);
    if (closing != std::string_view::npos) return line.find(separator, closing);
  }
  return line.find(separator);
}

std::string_view WithoutQuotes(std::string_view cell) {
  cell = Trim(cell);
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
  return Trim(cell.substr(1, cell.size() - 2));
}

}  // namespace

LineReader::LineReader(std::string_view text) : rest_(text) {
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
}

bool LineReader::Next(std::string_view* line) {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  *line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  rest_.remove_prefix(std::min<std::size_t>(rest_.starts_with("\r\n") ? 2 : 1, rest_.size()));
  ++number_;
  return true;
}

void SplitCells(std::string_view line, char separator, std::vector<std::string_view>* cells) {
  cells->clear();
  if (separator == ' ') {
    SplitAtBlanks(line, cells);
    if (cells->empty()) cells->emplace_back();
    return;
  }
  while (true) {
    const std::size_t end = EndOfCell(line, separator);
    cells->push_back(WithoutQuotes(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

char SeparatorOf(std::string_view line) {
  for (const char separator : {'\t', ';', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

char SeparatorOfNumbers(std::string_view line) {
  const char separator = SeparatorOf(line);
  if (separator != ',') return separator;
  std::vector<std::string_view> words;
  SplitAtBlanks(line, &words);
  const bool are_numbers = std::none_of(words.begin(), words.end(), [](std::string_view word) {
    return std::isnan(CellNumber(word, ' '));
  });
  return words.size() > 1 && are_numbers ? ' ' : separator;
}

double CellNumber(std::string_view cell, char separator) {
  if (const auto number = ParseDouble(cell)) return *number;
  if (separator == ',' || cell.find(',') == std::string_view::npos) return kNaN;
  std::string with_point(cell);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return ParseDouble(with_point).value_or(kNaN);
}

bool SaysNothing(std::string_view cell) {
  return cell.empty() || EqualIgnoringCase(cell, "nan") || EqualIgnoringCase(cell, "null") ||
         EqualIgnoringCase(cell, "(null)") || cell == "-";
}

bool StartsWithIgnoringCase(std::string_view text, std::string_view start) {
  return EqualIgnoringCase(Trim(text).substr(0, start.size()), start);
}

}  // namespace mmm_converter
