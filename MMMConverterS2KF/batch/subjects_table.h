// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace mmm_converter {

/// What a table says of a folder's or a recording's person: attributes of a manifest, and metadata.
struct SubjectsRow {
  std::map<std::string, std::string> attributes, metadata;
  bool is_used = false;
};

/// Reads the CSV table of ScanFolder: rows by what their first column says.
/// @throws Error with file and line.
std::map<std::string, SubjectsRow> ReadSubjectsTable(const std::string& file);

}  // namespace mmm_converter
