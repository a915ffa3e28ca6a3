// SPDX-License-Identifier: MIT
#include "common/io/xml/xml_text.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "common/io/xml/xml_document.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

std::string Decimal(double value, int decimals) {
  std::string text;
  AppendDecimal(value, decimals, &text);
  return text;
}

TEST(XmlText, ShortDecimals) {
  EXPECT_EQ(Decimal(0, 4), "0");
  EXPECT_EQ(Decimal(-0.0, 4), "0");
  EXPECT_EQ(Decimal(-0.00004, 4), "0");
  EXPECT_EQ(Decimal(-0.00006, 4), "-0.0001");
  EXPECT_EQ(Decimal(1141.02, 4), "1141.02");
  EXPECT_EQ(Decimal(-1141, 4), "-1141");
  EXPECT_EQ(Decimal(0.1 + 0.2, 9), "0.3");
  EXPECT_EQ(Decimal(100, 0), "100");
  EXPECT_EQ(Decimal(9.9999999999, 9), "10");
  EXPECT_EQ(Decimal(1e20, 9), "100000000000000000000");
  EXPECT_EQ(Decimal(-1.7976931348623157e308, 4).size(), 310u);
}

TEST(XmlText, DecimalsAreThePrintedOnesAndStable) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  for (int i = 0; i < 100000; ++i) {
    const double value = mantissa(random) * std::pow(10, i % 7);
    const std::string text = Decimal(value, 8);
    // Half a unit of the last decimal, and what double precision loses.
    EXPECT_NEAR(std::strtod(text.c_str(), nullptr), value, 0.5e-8 + 1e-9 * std::abs(value) * 1e-6);
    EXPECT_EQ(Decimal(std::strtod(text.c_str(), nullptr), 8), text);
  }
}

/// What AppendDecimal promises, the plain way: rounded half away from zero, no needless digits.
std::string PlainDecimal(double value, int decimals) {
  const double scaled = value * std::pow(10.0, decimals);
  if (std::abs(scaled) > 9e15) return fmt::format("{:.0f}", value);
  const long long digits = std::llround(scaled);
  const auto unit = static_cast<long long>(std::pow(10.0, decimals));
  std::string text = fmt::format("{}.{:0{}}", std::abs(digits) / unit, std::abs(digits) % unit,
                                 std::max(decimals, 1));
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return digits < 0 ? "-" + text : text;
}

TEST(XmlText, DecimalsAreThoseOfThePlainWay) {
  EXPECT_EQ(Decimal(0.5, 0), "1");
  EXPECT_EQ(Decimal(-2.5, 0), "-3");
  EXPECT_EQ(Decimal(0.125, 2), "0.13");
  EXPECT_EQ(Decimal(-0.125, 2), "-0.13");
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  for (int i = 0; i < 200000; ++i) {
    const int decimals = i % 10;
    double value = mantissa(random) * std::pow(10.0, i % 23 - 6);
    if (i % 3 == 0) value = std::round(value * 1000) / 1000;             // few digits
    if (i % 3 == 1) value = (std::floor(value) + 0.5) / (1 << (i % 8));  // halves
    ASSERT_EQ(Decimal(value, decimals), PlainDecimal(value, decimals)) << value << " " << decimals;
  }
}

TEST(XmlText, CommentsEndWhereTheyShould) {
  EXPECT_EQ(FormatXmlComment("a-b"), "<!-- a-b -->");
  for (const std::string text : {"--", "a--b", "-->", "--->", "-", "", "\x01 \xFF <x/>"}) {
    const XmlElement root = ParseXml("<r>" + FormatXmlComment(text) + "<c/></r>", text);
    EXPECT_EQ(root.children.size(), 1u) << text;
    EXPECT_EQ(FormatXmlComment(text).substr(4).find("--"), FormatXmlComment(text).size() - 7)
        << text;  // none but the end's
  }
}

TEST(XmlText, EscapedTextComesBack) {
  const std::string name = "a<b>&\"c' \xC3\xA4";
  EXPECT_EQ(*ParseXml("<a n='" + EscapeXml(name) + "'/>", "x").FindAttribute("n"), name);
  EXPECT_EQ(EscapeXml("Kn\xF6"), "Kn\xC3\xB6");  // Latin-1
  EXPECT_EQ(EscapeXml(std::string("a\0\x01z", 4)), "a  z");
  EXPECT_EQ(EscapeXml("\xE2\x82"), "\xC3\xA2\xC2\x82");  // a cut sequence
}

}  // namespace
}  // namespace mmm_converter
