// SPDX-License-Identifier: MIT
#include "common/support/text.h"

#include <gtest/gtest.h>

#include <string>

namespace mmm_converter {
namespace {

TEST(Text, TrimsBlanksAndNuls) {
  EXPECT_EQ(Trim(std::string_view(" \t LFHD \0\0", 10)), "LFHD");
  EXPECT_EQ(Trim("a b\r\n"), "a b");
  EXPECT_EQ(Trim("  "), "");
  EXPECT_EQ(Trim(""), "");
}

TEST(Text, ComparesWithoutCase) {
  EXPECT_TRUE(EqualIgnoringCase("RobotNode", "ROBOTnode"));
  EXPECT_FALSE(EqualIgnoringCase("RobotNode", "RobotNode2"));
  EXPECT_EQ(ToLower("LFhd-1"), "lfhd-1");
}

TEST(Text, ParsesWholeNumbersOnly) {
  EXPECT_EQ(ParseDouble(" +1.5e3 "), 1500.0);
  EXPECT_EQ(ParseDouble("-.25"), -0.25);
  EXPECT_EQ(ParseDouble("1,5"), std::nullopt);
  EXPECT_EQ(ParseDouble("1 2"), std::nullopt);
  EXPECT_EQ(ParseDouble(""), std::nullopt);
  EXPECT_EQ(ParseDouble("+-1"), std::nullopt);
  EXPECT_EQ(ParseDouble("1e999"), std::nullopt);
  EXPECT_EQ(ParseLong("42"), 42);
  EXPECT_EQ(ParseLong("42.0"), std::nullopt);
}

TEST(Text, ParsesLists) {
  std::vector<double> numbers = {7};
  EXPECT_TRUE(AppendDoubles(" 1 2.5\n-3 ", &numbers));
  EXPECT_TRUE(AppendDoubles("", &numbers));
  EXPECT_EQ(numbers, (std::vector<double>{7, 1, 2.5, -3}));
  EXPECT_FALSE(AppendDoubles("1 x 2", &numbers));
}

TEST(JoinNames, ReadsLikeASentence) {
  EXPECT_EQ(JoinNames({}), "");
  EXPECT_EQ(JoinNames({"a"}), "a");
  EXPECT_EQ(JoinNames({"a", "b", "c"}), "a, b or c");
  EXPECT_EQ(JoinNames({"a", "b"}, " and "), "a and b");
}

TEST(FirstNames, LeavesOutWhatIsTooMany) {
  EXPECT_EQ(FirstNames({}), "");
  EXPECT_EQ(FirstNames({"a", "b"}, 2), "a, b");
  EXPECT_EQ(FirstNames({"a", "b", "c"}, 2), "a, b, ...");
}

}  // namespace
}  // namespace mmm_converter
