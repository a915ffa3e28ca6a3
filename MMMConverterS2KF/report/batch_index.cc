// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/batch_index.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "MMMConverterS2KF/report/html.h"
#include "MMMConverterS2KF/report/page_sources.h"

namespace mmm_converter {
namespace {

// A member of all entries, each as JSON; "null" where an entry has none.
struct IndexColumn {
  std::string name;
  std::vector<std::string> values;
};

// Entries as columns: names stand once, values that occur often too.
class Columns {
 public:
  explicit Columns(std::size_t num_entries) : num_entries_(num_entries) {}

  void Set(const std::string& name, std::size_t entry, const Json& value) {
    if (value.is_null()) return;
    const auto [place, is_new] = places_.emplace(name, columns_.size());
    if (is_new) columns_.push_back({name, std::vector<std::string>(num_entries_, "null")});
    columns_[place->second].values[entry] = FormatJsonLine(value);
  }

  const std::vector<IndexColumn>& columns() const { return columns_; }

 private:
  std::size_t num_entries_;
  std::vector<IndexColumn> columns_;  // in the order in which they first had a value
  std::unordered_map<std::string, std::size_t> places_;
};

// Paths mostly contain the entry's id: [what stands before it, what stands after it].
Json WithoutId(const Json& path, const std::string& id) {
  if (!path.is_string() || id.empty()) return path;
  const auto& text = path.get_ref<const std::string&>();
  const std::size_t begin = text.find(id);
  if (begin == std::string::npos) return path;
  return Json::array({text.substr(0, begin), text.substr(begin + id.size())});
}

void AddEntry(const Json& result, std::size_t entry, Columns* columns) {
  const auto id = result.find("id");
  const std::string id_text = id != result.end() && id->is_string() ? id->get<std::string>() : "";
  for (const auto& [name, value] : result.items()) {
    if (name == "recording" || name == "motion" || name == "robot_motion" || name == "report") {
      columns->Set(name, entry, WithoutId(value, id_text));
    } else if (name == "metadata" && value.is_object()) {
      // Names of users: in a column of their own, as each entry may have others.
      Json names = Json::array();
      Json values = Json::array();
      for (const auto& [key, text] : value.items()) {
        names.push_back(key);
        values.push_back(text);
      }
      if (names.empty()) continue;
      columns->Set("metadata.names", entry, names);
      columns->Set("metadata.values", entry, values);
    } else if (value.is_object()) {
      for (const auto& [key, part] : value.items())
        columns->Set(fmt::format("{}.{}", name, key), entry, part);
    } else {
      columns->Set(name, entry, value);
    }
  }
}

template <typename Range>
std::string JsonArray(const Range& values) {
  return fmt::format("[{}]", fmt::join(values, ","));
}

// [value of each entry], or {"values": the different ones, "index": which of them each entry has}
// where that is shorter; without an index, all have the one value.
std::string FormatColumn(const IndexColumn& column) {
  std::vector<std::string_view> different;
  std::unordered_map<std::string_view, std::size_t> places;
  std::vector<std::size_t> index;
  index.reserve(column.values.size());
  for (const std::string& value : column.values) {
    const auto [place, is_new] = places.emplace(value, different.size());
    if (is_new) different.push_back(value);
    index.push_back(place->second);
  }
  if (different.size() == 1) return fmt::format(R"({{"values":{}}})", JsonArray(different));
  std::string listed = JsonArray(column.values);
  std::string indexed =
      fmt::format(R"({{"values":{},"index":{}}})", JsonArray(different), JsonArray(index));
  return indexed.size() < listed.size() ? indexed : listed;
}

std::string FormatEntries(const std::vector<Json>& results) {
  Columns columns(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) AddEntry(results[i], i, &columns);
  std::string formatted;
  for (const IndexColumn& column : columns.columns()) {
    if (!formatted.empty()) formatted += ",\n";
    formatted += FormatJsonLine(column.name) + ":" + FormatColumn(column);
  }
  return fmt::format("{{\"program\":\"MMMConverterS2KF {}\",\"entries\":{},\"columns\":{{\n{}}}}}",
                     MMM_CONVERTER_VERSION, results.size(), formatted);
}

}  // namespace

std::string FormatBatchIndex(const std::string& title, const std::vector<Json>& results) {
  const std::string data = DataBlock("batch", FormatEntries(results));
  return FormatPage({.title = title,
                     .styles = IndexStyles(),
                     .content = IndexContent(),
                     .data = data,
                     .libraries = {},
                     .script = {IndexScript(), IndexScriptSha256()}});
}

}  // namespace mmm_converter
