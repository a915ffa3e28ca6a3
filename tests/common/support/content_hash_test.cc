// SPDX-License-Identifier: MIT
#include "common/support/content_hash.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

// xxhsum -H128 of nothing, as published with xxHash.
TEST(ContentHash, OfNothing) { EXPECT_EQ(ContentHash().Hex(), "99aa06d3014798d86001c324468d497f"); }

TEST(ContentHash, DoesNotDependOnHowBytesCome) {
  std::string bytes(1000000, 'a');
  bytes[999999] = 'b';
  ContentHash whole;
  whole.Add(bytes);
  ContentHash parts;
  for (std::size_t i = 0; i < bytes.size(); i += 997)
    parts.Add(std::string_view(bytes).substr(i, 997));
  EXPECT_EQ(parts.Hex(), whole.Hex());
  const std::string file = testing::TestFolder() + "/file";
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(HashFile(file), whole.Hex());
  bytes[500000] = 'c';
  ContentHash other;
  other.Add(bytes);
  EXPECT_NE(other.Hex(), whole.Hex());
}

TEST(ContentHash, BoundsOfPartsCount) {
  ContentHash one;
  one.AddPart("ab");
  one.AddPart("c");
  ContentHash other;
  other.AddPart("a");
  other.AddPart("bc");
  EXPECT_NE(one.Hex(), other.Hex());
}

TEST(ContentHash, SaysWhichFileIsNotThere) {
  try {
    HashFile("/nowhere/at all");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/at all: can't be read: No such file or directory");
  }
  EXPECT_THROW(HashFile(testing::TestFolder()), Error);  // a folder
}

}  // namespace
}  // namespace mmm_converter
