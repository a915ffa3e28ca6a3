// SPDX-License-Identifier: MIT
#include "common/support/folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using Names = std::vector<std::string>;

TEST(Folder, NamesFilesAndStemsAreSorted) {
  const std::string& folder = testing::TestFolder();
  for (const char* name : {"b.xml", "a.xml", ".xml", "c.xml.old", "with a\nline.xml"}) {
    std::ofstream(folder + "/" + name) << "x";
  }
  std::filesystem::create_directory(folder + "/d");
  std::error_code failure = std::make_error_code(std::errc::io_error);
  EXPECT_EQ(NamesIn(folder, &failure),
            (Names{".xml", "a.xml", "b.xml", "c.xml.old", "d", "with a\nline.xml"}));
  EXPECT_FALSE(failure);
  EXPECT_EQ(StemsIn(folder, ".xml"), (Names{"a", "b", "with a\nline"}));
  EXPECT_EQ(FilesIn(folder + "/", ".xml"),
            (Names{folder + "/a.xml", folder + "/b.xml", folder + "/with a\nline.xml"}));
}

TEST(Folder, WhatIsNoneHasNothingAndTheReasonIsTold) {
  const std::string& folder = testing::TestFolder();
  std::error_code failure;
  EXPECT_TRUE(NamesIn(folder + "/none", &failure).empty());
  EXPECT_EQ(failure, std::errc::no_such_file_or_directory);
  std::ofstream(folder + "/file") << "x";
  EXPECT_TRUE(NamesIn(folder + "/file", &failure).empty());
  EXPECT_EQ(failure, std::errc::not_a_directory);
  EXPECT_TRUE(FilesIn(folder + "/none", ".xml").empty());
}

}  // namespace
}  // namespace mmm_converter
