// SPDX-License-Identifier: MIT
#include "common/io/tables/column_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "common/support/text.h"

namespace mmm_converter {

std::string OneWord(std::string_view text) {
  if (text.empty()) return "unnamed";
  std::string word(text);
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return c <= 0x20 || c == 0x7F; }, '_');
  return word;
}

std::string PlainCell(std::string_view text) {
  std::string cell = ToUtf8(text);
  const auto is_special = [](char c) { return c == '"' || c == '\\' || c == ',' || c == ';'; };
  std::replace_if(cell.begin(), cell.end(), is_special, '_');
  return cell;
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
  for (std::string& name : names) name = PlainCell(name);
  return ColumnNames(names);
}

}  // namespace mmm_converter
