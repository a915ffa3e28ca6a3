// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "common/io/bytes/file_content.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

TEST(OpenSimSampleTest, IsWhatItsGeneratorMakes) {
  const std::string folder = testing::TestFolder();
  const std::string shipped = testing::SourcePath("examples/opensim");
  std::filesystem::copy_file(shipped + "/generic.osim", folder + "/generic.osim",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string command = std::string("\"") + MAKE_OPENSIM_SAMPLE + "\" \"" + folder + "\"";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* name : {"/static.trc", "/walk.trc", "/walk_true.mot"}) {
    // Not EXPECT_EQ, which would print both files.
    EXPECT_TRUE(ReadFileContent(folder + name) == ReadFileContent(shipped + name)) << name;
  }
}

}  // namespace
}  // namespace mmm_converter
