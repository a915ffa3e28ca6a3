// SPDX-License-Identifier: MIT
#include "common/support/line_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
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

// A pipe that nobody writes to would never end, a device never either.
TEST_F(LineFileTest, IsARegularFile) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  for (const std::string& path : {path_, std::string("/dev/zero")}) {
    const std::vector<std::function<void()>> uses = {
        [&] { const LineFile file(path); },
        [&] { ForEachLine(path, [](std::string_view) { FAIL(); }); }};
    for (const auto& use : uses) {
      try {
        use();
        FAIL();
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr(path + ": is not a regular file"));
      }
    }
  }
}

// It may be somebody else's.
TEST_F(LineFileTest, OpeningChangesNothing) {
  std::ofstream(path_) << "one\ntw";
  { const LineFile file(path_); }
  EXPECT_EQ(std::filesystem::file_size(path_), 6U);
  const std::string link = path_ + "_link";
  std::filesystem::create_symlink(path_, link);
  try {
    const LineFile file(link);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(link + ": is a link"));
  }
}

TEST_F(LineFileTest, BeginsWithItsFirstBytes) {
  EXPECT_EQ(FirstBytes(path_, 3), "");
  std::ofstream(path_) << "one\ntwo";
  EXPECT_EQ(FirstBytes(path_, 3), "one");
  EXPECT_EQ(FirstBytes(path_, 30), "one\ntwo");
}

TEST_F(LineFileTest, LinesMayBeLongerThanABlock) {
  const std::string line(200000, 'x');
  LineFile(path_).Append(line);
  LineFile(path_).Append("y");
  EXPECT_THAT(Lines(), ElementsAre(line, "y"));
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

TEST_F(LineFileTest, StaysAsItWasWhereALineDoesNotFit) {
  LineFile file(path_);
  file.Append("one");
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  auto* const old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = old_limit;
  limit.rlim_cur = 6;  // bytes: a part of the line fits
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    file.Append("another");
  } catch (const WriteError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("File too large"));
  EXPECT_THAT(Lines(), ElementsAre("one"));
  EXPECT_TRUE(WriteError("file", ENOSPC).concerns_disk());
}

TEST_F(LineFileTest, SaysWhereItCannotBe) {
  EXPECT_THROW(LineFile("/nowhere/at all"), WriteError);
  EXPECT_FALSE(WriteError("file", EACCES).concerns_disk());
}

}  // namespace
}  // namespace mmm_converter
