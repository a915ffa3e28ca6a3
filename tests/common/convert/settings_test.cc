// SPDX-License-Identifier: MIT
#include "common/convert/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

enum class FilterKind { kS2kf, kUkf, kEkf };

struct Values {
  double deviation = 0.005;  // [m]
  double damping = 0.5;
  int samples = 301;
  bool robust = true;
  FilterKind kind = FilterKind::kS2kf;
};

SettingTable MakeTable(Values* values) {
  SettingTable table;
  table.AddElement("Noise", "What the filter believes of its input.");
  table.Add("Noise", "markerStandardDeviation_mm", &values->deviation, 1e-3, 0.001, 100,
            "white noise of a marker");
  table.Add("Noise", "damping", &values->damping, 1, 0, SettingTable::kUnlimited, "of velocities");
  table.AddElement("Filter", "Which filter.");
  table.AddChoice<FilterKind>(
      "Filter", "kind", &values->kind,
      {{"s2kf", FilterKind::kS2kf}, {"ukf", FilterKind::kUkf}, {"ekf", FilterKind::kEkf}},
      "which Kalman filter");
  table.Add("Filter", "samples", &values->samples, 3, 9999, "number of samples");
  table.Add("Filter", "robust", &values->robust, "gives far markers less weight");
  return table;
}

std::vector<std::string> ErrorsOf(const std::string& xml) {
  Values values;
  Diagnostics diagnostics("walk.xml");
  MakeTable(&values).Read(ParseXml(xml, "walk.xml").children, &diagnostics);
  return diagnostics.errors();
}

TEST(SettingTable, ReadsEachKindOfValue) {
  Values values;
  Diagnostics diagnostics("walk.xml");
  const XmlElement root = ParseXml(
      "<C><Filter kind='ekf' samples='93' robust='false'/>"
      "<Noise markerStandardDeviation_mm='2.5' damping='1e3'/></C>",
      "walk.xml");
  MakeTable(&values).Read(root.children, &diagnostics);
  EXPECT_THAT(diagnostics.errors(), ElementsAre());
  EXPECT_DOUBLE_EQ(values.deviation, 0.0025);
  EXPECT_EQ(values.damping, 1000);
  EXPECT_EQ(values.samples, 93);
  EXPECT_FALSE(values.robust);
  EXPECT_EQ(values.kind, FilterKind::kEkf);
}

TEST(SettingTable, WhatIsNotSaidKeepsItsValue) {
  Values values;
  Diagnostics diagnostics("walk.xml");
  MakeTable(&values).Read(ParseXml("<C><Noise damping='2'/></C>", "walk.xml").children,
                          &diagnostics);
  EXPECT_EQ(values.deviation, 0.005);
  EXPECT_EQ(values.kind, FilterKind::kS2kf);
}

TEST(SettingTable, ErrorsSayWhereAndWhatIsAllowed) {
  const auto errors =
      ErrorsOf("<C>\n<Nose/>\n<Noise dumping='1'/>\n<Filter samples='many'\n kind='kf'/>\n</C>");
  EXPECT_THAT(
      errors,
      ElementsAre("walk.xml:2: unknown element <Nose> (did you mean Noise?); use Noise or Filter",
                  "walk.xml:3: <Noise>: unknown attribute dumping (did you mean damping?); use "
                  "markerStandardDeviation_mm or damping",
                  "walk.xml:4: <Filter>: samples=\"many\" is not allowed; use a whole number "
                  "from 3 to 9999",
                  "walk.xml:4: <Filter>: kind=\"kf\" is not allowed; use s2kf, ukf or ekf"));
}

TEST(SettingTable, RefusesNumbersOutsideTheirRange) {
  for (const char* value : {"0", "100.1", "-1", "nan", "inf", "", "1 2", "1,5", "5mm"}) {
    EXPECT_THAT(ErrorsOf(std::string("<C><Noise markerStandardDeviation_mm='") + value + "'/></C>"),
                ElementsAre(HasSubstr("use a number from 0.001 to 100")))
        << value;
  }
  EXPECT_THAT(ErrorsOf("<C><Filter samples='3.5'/></C>"), ElementsAre(HasSubstr("3 to 9999")));
  EXPECT_THAT(ErrorsOf("<C><Filter samples='99999999999999999999'/></C>"),
              ElementsAre(HasSubstr("3 to 9999")));
  EXPECT_THAT(ErrorsOf("<C><Filter robust='yes'/></C>"),
              ElementsAre(HasSubstr("use true or false")));
}

TEST(SettingTable, RefusesRepeatedAndNestedElementsAndText) {
  EXPECT_THAT(ErrorsOf("<C>\n<Noise/>\n<Noise/></C>"),
              ElementsAre("walk.xml:3: <Noise> is already in line 2; keep one of them"));
  EXPECT_THAT(ErrorsOf("<C><Noise><Marker/></Noise></C>"),
              ElementsAre(HasSubstr("<Marker> can't be inside <Noise>")));
  EXPECT_THAT(ErrorsOf("<C><Noise>5</Noise></C>"), ElementsAre(HasSubstr("text \"5\"")));
}

TEST(SettingTable, TemplateIsReadBackToTheSameValues) {
  Values values;
  values.deviation = 0.0123456789;
  values.kind = FilterKind::kUkf;
  const std::string xml = "<C>\n" + MakeTable(&values).ToXml(2) + "</C>";
  Values again;
  Diagnostics diagnostics("template");
  MakeTable(&again).Read(ParseXml(xml, "template").children, &diagnostics);
  EXPECT_THAT(diagnostics.errors(), ElementsAre());
  EXPECT_NEAR(again.deviation, values.deviation, 1e-14);  // 12 digits are written
  EXPECT_EQ(again.damping, values.damping);
  EXPECT_EQ(again.samples, values.samples);
  EXPECT_EQ(again.robust, values.robust);
  EXPECT_EQ(again.kind, values.kind);
  EXPECT_THAT(xml, HasSubstr("white noise of a marker (a number from 0.001 to 100)"));
  EXPECT_THAT(xml, HasSubstr("  <Filter\n      kind=\"ukf\"\n"));
}

TEST(SettingTable, BreaksLongDocumentation) {
  double value = 1;
  SettingTable table;
  std::string words;
  for (int i = 0; i < 30; ++i) words += "documentation ";
  table.AddElement("Noise", words);
  table.Add("Noise", "value", &value, 1, 0, 1, words);
  std::istringstream lines(table.ToXml(2));
  int number = 0;
  for (std::string line; std::getline(lines, line); ++number) EXPECT_LE(line.size(), 104u) << line;
  EXPECT_GT(number, 8);
}

TEST(SettingTable, WritesConversionsToSiWithoutTheirRounding) {
  Values values;
  values.deviation = 0.0035;  // 0.0035 / 1e-3 = 3.5000000000000004 in binary
  EXPECT_THAT(MakeTable(&values).ToXml(0), HasSubstr("markerStandardDeviation_mm=\"3.5\""));
}

}  // namespace
}  // namespace mmm_converter
