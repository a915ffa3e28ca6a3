// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/journal.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <vector>

#include "common/support/content_hash.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;

class JournalTest : public ::testing::Test {
 protected:
  JournalTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  std::vector<JournalRecord> Read() const {
    std::vector<JournalRecord> records;
    ReadJournals(folder_, [&](JournalRecord record) { records.push_back(std::move(record)); });
    return records;
  }

  static JournalRecord Record(const std::string& id) {
    JournalRecord record;
    record.id = id;
    record.converted = true;
    record.fingerprint = "f";
    record.recording = {123, 1700000000123456789, "h"};
    record.outputs = {{"motions/" + id + ".xml", 45}};
    record.result = R"({"state":"converted"})";
    return record;
  }

  std::string folder_ = ::testing::TempDir() + "/journal_" +
                        ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(JournalTest, GivesBackWhatWasWritten) {
  JournalRecord record = Record("a/\"b\"");
  Journal(folder_, 1, 1, true).Append(record);
  const std::vector<JournalRecord> records = Read();
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].id, record.id);
  EXPECT_TRUE(records[0].converted);
  EXPECT_EQ(records[0].fingerprint, "f");
  EXPECT_EQ(records[0].recording.bytes, 123U);
  EXPECT_EQ(records[0].recording.modified, 1700000000123456789);
  EXPECT_EQ(records[0].recording.hash, "h");
  EXPECT_EQ(records[0].outputs, record.outputs);
  EXPECT_EQ(records[0].result, record.result);
}

TEST_F(JournalTest, ShardsHaveTheirOwnAndAllAreRead) {
  Journal(folder_, 1, 2, true).Append(Record("a"));
  Journal(folder_, 2, 2, true).Append(Record("b"));
  Journal(folder_, 1, 1, true).Append(Record("c"));
  EXPECT_TRUE(fs::exists(folder_ + "/journal.2of2.jsonl"));
  EXPECT_EQ(Read().size(), 3U);
  Journal(folder_, 1, 2, true).Append(Record("d"));  // fresh: "a" is gone
  Journal(folder_, 2, 2, false).Append(Record("e"));
  EXPECT_EQ(Read().size(), 4U);
}

TEST_F(JournalTest, LeavesOutWhatItDoesNotUnderstand) {
  std::ofstream(folder_ + "/journal.jsonl")
      << "{}\nnonsense\n{\"id\":\"a\",\"converted\":1}\n[1]\n";
  Journal(folder_, 1, 1, false).Append(Record("b"));
  EXPECT_EQ(Read().size(), 1U);
  EXPECT_THROW(ReadJournals(folder_ + "/nowhere", [](const JournalRecord&) {}), Error);
}

TEST_F(JournalTest, KnowsWhetherARecordingHasChanged) {
  const std::string file = folder_ + "/walk.c3d";
  std::ofstream(file) << "old";
  RecordedFile recorded = InspectFile(file);
  recorded.hash = HashFile(file);
  EXPECT_TRUE(IsUnchanged(file, recorded));
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::hours(1));
  EXPECT_TRUE(IsUnchanged(file, recorded));  // copied anew
  std::ofstream(file) << "new";
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::hours(1));
  EXPECT_FALSE(IsUnchanged(file, recorded));
  std::ofstream(file) << "longer";
  EXPECT_FALSE(IsUnchanged(file, recorded));
  fs::remove(file);
  EXPECT_THROW(IsUnchanged(file, recorded), Error);
}

}  // namespace
}  // namespace mmm_converter
