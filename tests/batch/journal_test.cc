// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/journal.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

class JournalTest : public ::testing::Test {
 protected:
  static JournalRecord Record(const std::string& id) {
    JournalRecord record;
    record.id = id;
    record.fingerprint = "f";
    record.recording = {123, 1700000000123456789, "h"};
    record.outputs = {{"motions/" + id + ".xml", {45, 6, "o"}}};
    record.inputs = {{"../objects/cup.xml", {7, 8, "m"}}};
    record.result.figures = EntryFigures();
    record.result.seconds = 0.5;
    return record;
  }

  const std::string folder_ = testing::TestFolder();
};

TEST_F(JournalTest, GivesBackWhatWasWritten) {
  const JournalRecord written = Record("a/\"b\"");
  Journal(folder_, 1, 1).Append(written);
  const auto records = ReadJournals(folder_);
  ASSERT_EQ(records.size(), 1U);
  const JournalRecord& record = records.at(written.id);
  EXPECT_EQ(record.id, written.id);
  EXPECT_GT(record.time, 0);
  EXPECT_TRUE(record.result.converted());
  EXPECT_EQ(record.fingerprint, "f");
  EXPECT_EQ(record.recording.bytes, 123U);
  EXPECT_EQ(record.recording.modified, 1700000000123456789);
  EXPECT_EQ(record.recording.hash, "h");
  ASSERT_EQ(record.outputs.size(), 1U);
  const FileState& output = record.outputs.at("motions/a/\"b\".xml");
  EXPECT_EQ(output.bytes, 45U);
  EXPECT_EQ(output.modified, 6);
  EXPECT_EQ(output.hash, "o");
  EXPECT_EQ(record.inputs.at("../objects/cup.xml").hash, "m");
  EXPECT_EQ(record.result.seconds, 0.5);
}

TEST_F(JournalTest, ShardsHaveTheirOwnAndTheLatestRecordHolds) {
  Journal(folder_, 1, 2).Append(Record("a"));
  Journal(folder_, 2, 2).Append(Record("b"));
  JournalRecord failed = Record("a");
  failed.result = Failed("why", 0);
  Journal(folder_, 1, 1).Append(failed);
  EXPECT_TRUE(fs::exists(folder_ + "/journal.2of2.jsonl"));
  Journal(folder_, 1, 2).Append(Record("c"));  // the first journal is the newest file now
  const auto records = ReadJournals(folder_);
  EXPECT_EQ(records.size(), 3U);
  EXPECT_FALSE(records.at("a").result.converted());
}

TEST_F(JournalTest, AClockThatIsSetBackMakesNoRecordOlder) {
  constexpr std::int64_t kYear3000 = 32503680000000;
  Journal(folder_, 1, 1).Append(Record("a"));
  std::stringstream line;
  line << std::ifstream(folder_ + "/journal.jsonl").rdbuf();
  auto json = nlohmann::json::parse(line.str());
  json["time_ms"] = kYear3000;
  std::ofstream(folder_ + "/journal.jsonl") << json << "\n";
  JournalRecord failed = Record("a");
  failed.result = Failed("why", 0);
  Journal(folder_, 1, 2).Append(failed);
  EXPECT_GT(ReadJournals(folder_).at("a").time, kYear3000);
  EXPECT_FALSE(ReadJournals(folder_).at("a").result.converted());
}

TEST_F(JournalTest, LeavesOutWhatItDoesNotUnderstand) {
  std::ofstream(folder_ + "/journal.jsonl")
      << "{}\nnonsense\n{\"id\":\"a\",\"converted\":1}\n[1]\n";
  Journal(folder_, 1, 1).Append(Record("b"));
  EXPECT_EQ(ReadJournals(folder_).size(), 1U);
  EXPECT_TRUE(ReadJournals(folder_ + "/nowhere").empty());
}

TEST_F(JournalTest, AFileOfAnotherKindStaysAsItIs) {
  const std::string text = "a list of the laboratory\nwithout an end";
  std::ofstream(folder_ + "/journal.jsonl") << text;
  EXPECT_THROW(Journal(folder_, 1, 1), Error);
  std::stringstream now;
  now << std::ifstream(folder_ + "/journal.jsonl").rdbuf();
  EXPECT_EQ(now.str(), text);
}

TEST_F(JournalTest, LeavesOutWhatIsNestedWithoutEnd) {
  constexpr int kDepth = 200000;
  std::ofstream(folder_ + "/journal.jsonl") << std::string(kDepth, '[') + std::string(kDepth, ']') +
                                                   "\n{\"id\":" + std::string(kDepth, '[') +
                                                   std::string(kDepth, ']') + "}\n";
  Journal(folder_, 1, 1).Append(Record("b"));
  EXPECT_EQ(ReadJournals(folder_).size(), 1U);
}

TEST_F(JournalTest, KnowsWhetherAFileHasChanged) {
  const std::string file = folder_ + "/walk.c3d";
  std::ofstream(file) << "old";
  const FileState state = InspectFile(file);
  EXPECT_TRUE(IsUnchanged(file, state));
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::hours(1));
  EXPECT_TRUE(IsUnchanged(file, state));  // copied anew
  std::ofstream(file) << "new";
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::hours(1));
  EXPECT_FALSE(IsUnchanged(file, state));
  std::ofstream(file) << "longer";
  EXPECT_FALSE(IsUnchanged(file, state));
  fs::remove(file);
  EXPECT_THROW(IsUnchanged(file, state), Error);
}

}  // namespace
}  // namespace mmm_converter
