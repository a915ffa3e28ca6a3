// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/report/batch_index.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/report/comparison_cases.h"
#include "tests/report/result_cases.h"

namespace mmm_converter {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// What the page's script reads.
json Data(const std::string& page) {
  const std::string start = "<script type=\"application/json\" class=\"batch\">";
  const std::size_t begin = page.find(start) + start.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

json ValueAt(const json& column, std::size_t entry) {
  if (column.is_array()) return column[entry];
  const std::size_t index =
      column.contains("index") ? column["index"][entry].get<std::size_t>() : 0;
  return column["values"][index];
}

// A result as the page has it: its members by path, without those that are null.
json EntryOf(const json& data, std::size_t entry) {
  json members;
  for (const auto& [name, column] : data["columns"].items()) {
    json value = ValueAt(column, entry);
    if (value.is_array() && (name == "recording" || name == "motion" || name == "report")) {
      value = value[0].get<std::string>() +
              ValueAt(data["columns"]["id"], entry).get<std::string>() +
              value[1].get<std::string>();
    }
    if (!value.is_null()) members[name] = value;
  }
  return members;
}

// The same from the result itself.
json MembersOf(const json& result) {
  json members;
  for (const auto& [name, value] : result.items()) {
    if (name == "metadata") {
      for (const auto& [key, text] : value.items()) {
        members["metadata.names"].push_back(key);
        members["metadata.values"].push_back(text);
      }
    } else if (value.is_object()) {
      for (const auto& [key, part] : value.items()) {
        if (!part.is_null()) members[fmt::format("{}.{}", name, key)] = part;
      }
    } else if (!value.is_null()) {
      members[name] = value;
    }
  }
  return members;
}

TEST(BatchIndex, EveryMemberIsThatOfTheResults) {
  const std::vector<Json> results = testing::ManyResults(300);
  const json data = Data(FormatBatchIndex("kit", results));
  ASSERT_EQ(data["entries"], results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(EntryOf(data, i), MembersOf(results[i])) << i;
  }
}

TEST(BatchIndex, WhatIsAlwaysTheSameStandsOnce) {
  const std::string page = FormatBatchIndex("kit", testing::ManyResults(300));
  EXPECT_EQ(Count(page, "S2KFConverter"), 1);
  EXPECT_EQ(Count(page, "\"distance_mm.mean\":"), 1);
  EXPECT_EQ(Count(page, "no shard has converted it"), 1);
}

TEST(BatchIndex, HostileTextEndsNoElement) {
  const std::string page = FormatBatchIndex(testing::kHostileText, testing::HostileResults());
  // The data and our script.
  EXPECT_EQ(Count(page, "<script"), 2);
  EXPECT_EQ(Count(page, "</script"), 2);
  EXPECT_EQ(Count(page, "<title>"), 1);
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("<title>&lt;/script&gt;&lt;script&gt;window.hacked=1"));
  const json data = Data(page);
  EXPECT_EQ(ValueAt(data["columns"]["group"], 0), testing::kHostileText);
  EXPECT_EQ(ValueAt(data["columns"]["warnings"], 0)[1], testing::kHostileText);
}

TEST(BatchIndex, NothingIsLoadedFromElsewhere) {
  const std::string page = FormatBatchIndex("kit", testing::ManyResults(10));
  EXPECT_THAT(page, AllOf(HasSubstr("default-src 'none'"), Not(HasSubstr("<link")),
                          Not(HasSubstr("@import")), Not(HasSubstr("<script src")),
                          Not(HasSubstr("url("))));
}

TEST(BatchIndex, MayBeEmpty) {
  const std::string page = FormatBatchIndex("nothing", {});
  EXPECT_THAT(page, HasSubstr("nothing</h1>"));
  EXPECT_EQ(Data(page)["entries"], 0);
  EXPECT_EQ(Data(page)["columns"], json::object());
}

TEST(BatchIndex, MetadataOfManyNamesStaySmall) {
  std::vector<Json> results;
  results.reserve(2000);
  for (int i = 0; i < 2000; ++i) {
    const std::string name = "name" + std::to_string(i);
    results.push_back({{"id", name}, {"metadata", {{name, "x"}}}});
  }
  // About 30 characters an entry; a column for each name would be 2000 * 2000.
  EXPECT_LT(FormatBatchIndex("names", results).size(), 200'000);
}

}  // namespace
}  // namespace mmm_converter
