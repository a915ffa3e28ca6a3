// SPDX-License-Identifier: MIT
#include "common/io/npz/numpy_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string Npy(const std::string& type, const std::string& order, const std::string& shape,
                const std::string& bytes) {
  const std::string head =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(head.size()) + '\0' + head + bytes;
}

NumpyArray Read(const std::string& npy, std::size_t most_columns = 1000) {
  NumpyReader reader("walk.npy", most_columns);
  for (const char byte : npy) reader.Add(std::string_view(&byte, 1));  // however it comes
  return reader.Finish();
}

TEST(NumpyArray, NumbersAreOfAnyWidthAndOrderOfBytes) {
  using namespace std::string_literals;
  const auto number = [](const std::string& type, const std::string& bytes) {
    return Read(Npy(type, "False", "()", bytes)).Number(0, 0);
  };
  EXPECT_EQ(number("<f2", "\x00\x3c"s), 1);
  EXPECT_EQ(number(">f2", "\xc0\x00"s), -2);
  EXPECT_EQ(number("<f2", "\x01\x00"s), std::ldexp(1, -24));
  EXPECT_TRUE(std::isnan(number("<f2", "\x00\x7c"s)));
  EXPECT_EQ(number("<f4", "\x00\x00\x80\x3f"s), 1);
  EXPECT_EQ(number(">f8", "\xc0\x00\x00\x00\x00\x00\x00\x00"s), -2);
  EXPECT_EQ(number("|i1", "\xff"s), -1);
  EXPECT_EQ(number("<i8", "\x78\x00\x00\x00\x00\x00\x00\x00"s), 120);
  EXPECT_EQ(number("|u1", "\xff"s), 255);
  EXPECT_EQ(number("|b1", "\x01"s), 1);
  EXPECT_EQ(Read(Npy("<U2", "False", "()", "o\0\0\0k\0\0\0"s)).Text(), "ok");
}

TEST(NumpyArray, RowsAreThoseOfTheFirstAxis) {
  for (const std::size_t columns : {std::size_t{2}, std::size_t{3}}) {
    const NumpyArray c = Read(Npy("|i1", "False", "(2, 3)", "\1\2\3\4\5\6"), columns);
    const NumpyArray fortran = Read(Npy("|i1", "True", "(2, 3)", "\1\4\2\5\3\6"), columns);
    for (const NumpyArray* array : {&c, &fortran}) {
      EXPECT_EQ(array->rows(), 2U);
      EXPECT_EQ(array->row_size(), 3U);
      EXPECT_EQ(array->Number(0, 1), 2);
      EXPECT_EQ(array->Number(1, 0), 4);
    }
  }
  const NumpyArray cube = Read(Npy("|i1", "True", "(2, 1, 2)", "\1\3\2\4"));
  EXPECT_EQ(cube.Number(1, 0), 3);
  EXPECT_EQ(ShapeText(cube.head()), "(2, 1, 2)");
}

TEST(NumpyArray, WhatIsNoArrayOfNumbersIsRefused) {
  const auto expect = [](const std::string& npy, const std::string& what) {
    EXPECT_THAT([&] { Read(npy); }, ThrowsMessage<Error>(HasSubstr("walk.npy: " + what)));
  };
  expect(Npy("|O", "False", "(3,)", "..."), "is an array of Python's objects");
  expect(Npy("<c8", "False", "(3,)", "..."), "has elements of the type \"<c8\"");
  expect(Npy("<f3", "False", "(3,)", "..."), "has elements of the type");
  expect(Npy("<f4", "False", "(-3,)", "..."), "says no shape");
  expect(Npy("<f4", "False", "(99999999, 99999999)", "..."), "says no shape");
  expect(Npy("<f8", "False", "(2, 2)", "12345678"), "is cut: of an array of the shape (2, 2)");
  expect("PK and so on", "is no array");
  expect(std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff", 12), "says that its header has");
  expect("\x93NUM", "is cut in the header");
}

}  // namespace
}  // namespace mmm_converter
