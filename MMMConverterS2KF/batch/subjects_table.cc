// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/subjects_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "common/io/bytes/file_content.h"
#include "common/support/diagnostics.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

constexpr std::size_t kMaxTableBytes = std::size_t{64} << 20;

struct CsvLine {
  int line = 0;
  std::vector<std::string> fields;
};

// RFC 4180; blanks around fields are left out, empty lines too.
std::vector<CsvLine> ParseCsv(std::string_view text) {
  std::vector<CsvLine> lines;
  CsvLine current;
  std::string field;
  bool is_quoted = false;
  int line = 1;
  current.line = line;
  const auto end_field = [&] {
    current.fields.emplace_back(Trim(field));
    field.clear();
  };
  const auto end_line = [&] {
    end_field();
    if (current.fields.size() > 1 || !current.fields.front().empty()) lines.push_back(current);
    current = {};
    current.line = line;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (is_quoted) {
      const bool is_double = c == '"' && i + 1 < text.size() && text[i + 1] == '"';
      if (is_double) ++i;
      if (c == '"' && !is_double) {
        is_quoted = false;
      } else {
        field += c;
      }
    } else if (c == '"') {
      is_quoted = true;
    } else if (c == ',') {
      end_field();
    } else if (c == '\n') {
      end_line();
    } else {
      field += c;
    }
  }
  end_line();
  return lines;
}

// Without "./" in front and "/" behind.
std::string PlainPath(const std::string& path) {
  std::string plain = std::filesystem::path(path).lexically_normal().generic_string();
  if (plain.size() > 1 && plain.ends_with('/')) plain.pop_back();
  return plain;
}

}  // namespace

std::map<std::string, SubjectsRow> ReadSubjectsTable(const std::string& file) {
  static const std::map<std::string, std::string> kAttributes = {
      {"height_m", "height_m"}, {"mass_kg", "mass_kg"}, {"subject_file", "subjectFile"}};
  std::string text = ReadFileContent(file, kMaxTableBytes);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  const std::vector<CsvLine> lines = ParseCsv(text);
  if (lines.empty() ||
      (lines.front().fields.front() != "folder" && lines.front().fields.front() != "file")) {
    throw Error(file +
                ":1: the first column must be \"folder\" or \"file\"; for instance "
                "folder,height_m,mass_kg");
  }
  const std::vector<std::string>& names = lines.front().fields;
  Diagnostics diagnostics(file);
  std::map<std::string, SubjectsRow> rows;
  for (const CsvLine& line : lines) {
    if (&line == &lines.front()) continue;
    if (line.fields.size() != names.size()) {
      diagnostics.AddError(line.line, fmt::format("has {} fields, the first line has {}",
                                                  line.fields.size(), names.size()));
      continue;
    }
    SubjectsRow row;
    for (std::size_t i = 1; i < names.size(); ++i) {
      if (line.fields[i].empty()) continue;
      const auto attribute = kAttributes.find(names[i]);
      if (attribute != kAttributes.end()) {
        row.attributes[attribute->second] = line.fields[i];
      } else {
        row.metadata[names[i]] = line.fields[i];
      }
    }
    if (!rows.emplace(PlainPath(line.fields.front()), std::move(row)).second) {
      diagnostics.AddError(line.line, fmt::format("\"{}\" is there twice", line.fields.front()));
    }
  }
  diagnostics.ThrowIfErrors();
  return rows;
}

}  // namespace mmm_converter
