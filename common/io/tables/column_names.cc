// SPDX-License-Identifier: MIT
#include "common/io/tables/column_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace mmm_converter {

std::string OneWord(std::string_view text) {
  if (text.empty()) return "unnamed";
  std::string word(text);
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return c <= 0x20 || c == 0x7F; }, '_');
  return word;
}

std::vector<std::string> ColumnNames(const std::vector<std::string>& names) {
  std::vector<std::string> words;
  words.reserve(names.size());
  std::set<std::string> used;
  for (const std::string& name : names) {
    const std::string plain = OneWord(name);
    std::string word = plain;
    for (int i = 2; !used.insert(word).second; ++i) word = fmt::format("{}_{}", plain, i);
    words.push_back(std::move(word));
  }
  return words;
}

std::vector<std::string> CsvColumnNames(std::vector<std::string> names) {
  for (std::string& name : names) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ',' || c == ';' || c == '"'; }, '_');
  }
  return ColumnNames(names);
}

}  // namespace mmm_converter
