// SPDX-License-Identifier: MIT
#include "common/support/line_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LineFileTest : public ::testing::Test {
 protected:
  std::vector<std::string> Lines() const {
    std::vector<std::string> lines;
    ForEachLine(path_, [&](std::string_view line) { lines.emplace_back(line); });
    return lines;
  }

  const std::string path_ = testing::TestFolder() + "/lines";
};

TEST_F(LineFileTest, KeepsLinesFromRunToRun) {
  EXPECT_THAT(Lines(), IsEmpty());
  {
    LineFile file(path_);
    file.Append("one");
    file.Append("");
  }
  LineFile(path_).Append("three");
  EXPECT_THAT(Lines(), ElementsAre("one", "", "three"));
}

TEST_F(LineFileTest, CutsOffWhatAKilledProcessLeft) {
  std::ofstream(path_) << "one\ntw";
  EXPECT_THAT(Lines(), ElementsAre("one"));
  LineFile(path_).Append("three");
  EXPECT_THAT(Lines(), ElementsAre("one", "three"));
}

TEST_F(LineFileTest, WithoutAWholeLineIsEmpty) {
  std::ofstream(path_) << "half";
  LineFile(path_).Append("whole");
  EXPECT_THAT(Lines(), ElementsAre("whole"));
}

TEST_F(LineFileTest, HasOneWriter) {
  LineFile file(path_);
  file.Append("one");
  try {
    LineFile(path_).Append("two");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("another process is writing to it"));
  }
  EXPECT_THAT(Lines(), ElementsAre("one"));
}

TEST_F(LineFileTest, AFullDiskIsSaid) {
  LineFile file("/dev/full");
  try {
    file.Append("one");
    FAIL();
  } catch (const WriteError& error) {
    EXPECT_TRUE(error.concerns_disk());
    EXPECT_THAT(error.what(), HasSubstr("No space left on device"));
  }
}

TEST_F(LineFileTest, SaysWhereItCannotBe) {
  EXPECT_THROW(LineFile("/nowhere/at all"), WriteError);
  EXPECT_FALSE(WriteError("file", EACCES).concerns_disk());
}

}  // namespace
}  // namespace mmm_converter
