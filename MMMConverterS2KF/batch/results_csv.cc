// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "MMMConverterS2KF/batch/result_files.h"

namespace mmm_converter {
namespace {

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += c;
    field += c;
  }
  field += '"';
  return field;
}

std::string CellOf(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : FormatJsonLine(value);
}

struct CsvCell {
  std::string column, text;
};

// Objects become columns "a.b", arrays one text.
void AddCells(const std::string& name, const Json& value, std::vector<CsvCell>* row) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) {
      std::string column = name;
      if (!column.empty()) column += '.';
      AddCells(column += key, part, row);
    }
  } else if (value.is_array()) {
    std::string text;
    for (const Json& part : value) text += (text.empty() ? "" : "; ") + CellOf(part);
    row->push_back({name, text});
  } else {
    row->push_back({name, CellOf(value)});
  }
}

// Columns in the order of the first row that has them; those of metadata by name, after the others.
std::vector<std::string> ColumnsOf(const std::vector<std::vector<CsvCell>>& rows) {
  std::vector<std::string> columns;
  std::set<std::string> known;
  std::set<std::string> metadata;
  for (const std::vector<CsvCell>& row : rows) {
    for (const CsvCell& cell : row) {
      if (cell.column.starts_with("metadata.")) {
        metadata.insert(cell.column);
      } else if (known.insert(cell.column).second) {
        columns.push_back(cell.column);
      }
    }
  }
  columns.insert(columns.end(), metadata.begin(), metadata.end());
  return columns;
}

std::string FormatRow(const std::vector<std::string>& texts) {
  std::string line;
  for (std::size_t i = 0; i < texts.size(); ++i) line += (i > 0 ? "," : "") + CsvField(texts[i]);
  return line + "\n";
}

}  // namespace

std::string FormatResultsCsv(const std::vector<Json>& lines) {
  std::vector<std::vector<CsvCell>> rows(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) AddCells("", lines[i], &rows[i]);
  const std::vector<std::string> columns = ColumnsOf(rows);
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < columns.size(); ++i) places[columns[i]] = i;
  std::string csv = FormatRow(columns);
  for (const std::vector<CsvCell>& row : rows) {
    std::vector<std::string> texts(columns.size());
    for (const CsvCell& cell : row) texts[places.at(cell.column)] = cell.text;
    csv += FormatRow(texts);
  }
  return csv;
}

}  // namespace mmm_converter
