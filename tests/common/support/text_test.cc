// SPDX-License-Identifier: MIT
#include "common/support/text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mmm_converter {
namespace {

TEST(Text, TrimsBlanksAndNuls) {
  EXPECT_EQ(Trim(std::string_view(" \t LFHD \0\0", 10)), "LFHD");
  EXPECT_EQ(Trim("a b\r\n"), "a b");
  EXPECT_EQ(Trim("  "), "");
  EXPECT_EQ(Trim(""), "");
}

TEST(Text, SplitsAtSeparators) {
  using Parts = std::vector<std::string>;
  EXPECT_EQ(Split("a, b c ,", ','), (Parts{"a", "b c", ""}));
  EXPECT_EQ(Split("", ','), Parts{""});
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

TEST(Text, BytesThatAreNotUtf8AreTakenAsLatin1) {
  EXPECT_EQ(ToUtf8("Kn\xF6"), "Kn\xC3\xB6");
  EXPECT_EQ(ToUtf8("Kn\xC3\xB6 \xE2\x82\xAC \xF0\x9F\x98\x80"),
            "Kn\xC3\xB6 \xE2\x82\xAC \xF0\x9F\x98\x80");
  EXPECT_EQ(ToUtf8(std::string("a\0\x1Bz", 4)), "a  z");
  EXPECT_TRUE(IsUtf8("Kn\xC3\xB6"));
  // Cut, longer than needed, half of a UTF-16 pair, beyond Unicode, no character.
  for (const char* const none : {"\xE2\x82", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80",
                                 "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xEF\xBF\xBE"}) {
    EXPECT_FALSE(IsUtf8(none));
    EXPECT_TRUE(IsUtf8(ToUtf8(none)));
  }
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
