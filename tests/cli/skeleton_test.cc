// SPDX-License-Identifier: MIT
// A skeleton's motion is an input of the commands that take a recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/program.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using testing::WriteText;

/// The beginning of the sample, tracked and exported.
std::string Exported() {
  const std::string file = TestFolder() + "/sample.bvh";
  const auto run = RunProgram({"convert", testing::Handstand(), "--height", "1.8", "--frames",
                               ":60", "-o", TestFolder() + "/sample.xml", "--export-bvh", file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return file;
}

TEST(Skeleton, IsConvertedDescribedAndShown) {
  const std::string file = Exported();
  const auto info = RunProgram({"info", file});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("BVH"));
  EXPECT_THAT(info.out, HasSubstr("60"));
  const std::string page = TestFolder() + "/page.html";
  const auto run = RunProgram({"convert", file, "-o", TestFolder() + "/again.xml", "--export-bvh",
                               TestFolder() + "/again.bvh", "--report", page});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("by the lengths of the skeleton"));
  EXPECT_TRUE(std::filesystem::exists(page));
  EXPECT_THAT(ReadText(TestFolder() + "/again.bvh"), HasSubstr("Frames: 60"));
}

TEST(Skeleton, CutFilesAreRefusedOrReadAsFarAsTheyGo) {
  const std::string whole = ReadText(Exported());
  const std::string file = TestFolder() + "/cut.bvh", out = TestFolder() + "/cut.xml";
  WriteText(file, whole.substr(0, 400));
  const auto refused = RunProgram({"convert", file, "-o", out});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("cut.bvh:"));
  EXPECT_FALSE(std::filesystem::exists(out));
  WriteText(file, whole.substr(0, whole.size() * 3 / 4));
  const auto read = RunProgram({"convert", file, "-o", out});
  EXPECT_EQ(read.exit_code, 0) << read.err;
  EXPECT_THAT(read.out + read.err, HasSubstr("cut off"));
}

}  // namespace
}  // namespace mmm_converter
