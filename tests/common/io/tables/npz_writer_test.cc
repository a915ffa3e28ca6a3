// SPDX-License-Identifier: MIT
// That NumPy reads the files, tests/python says.
#include "common/io/tables/npz_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace mmm_converter {
namespace {

std::string Bytes(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  return text;
}

TEST(NpzWriterTest, NumbersAreLittleEndianInCOrder) {
  const std::string npy = FormatNpy({"a", {2, 1}, {1, -0.5}, {}});
  ASSERT_EQ(npy.size(), 128u + 16u);
  EXPECT_EQ(npy.substr(0, 10), "\x93NUMPY" + Bytes({1, 0, 118, 0}));
  EXPECT_TRUE(
      npy.substr(10).starts_with("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1), }"));
  EXPECT_EQ(npy[127], '\n');
  EXPECT_EQ(npy.substr(128), Bytes({0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0, 0, 0, 0, 0xe0, 0xbf}));
}

TEST(NpzWriterTest, TextsAreUtf32OfOneWidth) {
  const std::string npy = FormatNpy({"a", {2}, {}, {"ä€", "b"}});
  EXPECT_THAT(npy,
              ::testing::HasSubstr("'descr': '<U2', 'fortran_order': False, 'shape': (2,), }"));
  EXPECT_EQ(npy.substr(128), Bytes({0xe4, 0, 0, 0, 0xac, 0x20, 0, 0, 'b', 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_THAT(FormatNpy({"a", {}, {}, {"\xff"}}).substr(128), Bytes({0xff, 0, 0, 0}));
}

TEST(NpzWriterTest, AnArchiveHasStoredFilesAndTheirDirectory) {
  const std::vector<NpyArray> arrays = {{"one", {1}, {1}, {}}, {"two", {}, {}, {"b"}}};
  const std::string npz = Join(FormatNpz(arrays));
  EXPECT_EQ(npz, Join(FormatNpz(arrays)));
  const std::string one = FormatNpy(arrays[0]);
  EXPECT_TRUE(npz.starts_with(
      Bytes({'P', 'K', 3, 4, 20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0})));  // stored, 1980-01-01
  EXPECT_EQ(npz.substr(30, 7), "one.npy");
  EXPECT_EQ(npz.substr(37, one.size()), one);
  const std::size_t end = npz.size() - 22;
  EXPECT_EQ(npz.substr(end, 12), Bytes({'P', 'K', 5, 6, 0, 0, 0, 0, 2, 0, 2, 0}));
  std::uint32_t directory = 0;
  std::memcpy(&directory, npz.data() + end + 16, 4);
  EXPECT_EQ(npz.substr(directory, 4), Bytes({'P', 'K', 1, 2}));
}

TEST(NpzWriterTest, NoArraysAreAnEmptyArchive) {
  EXPECT_EQ(Join(FormatNpz({})), Bytes({'P', 'K', 5, 6}) + std::string(18, '\0'));
}

}  // namespace
}  // namespace mmm_converter
