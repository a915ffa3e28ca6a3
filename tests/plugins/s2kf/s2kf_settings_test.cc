// SPDX-License-Identifier: MIT
#include "plugins/s2kf/s2kf_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "common/support/error.h"
#include "tests/plugins/s2kf/tracking_run.h"

namespace mmm_converter::s2kf {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

S2kfSettings Read(const std::string& elements) {
  return ReadSettings(ParseConverterConfig(
      "<ConverterConfig type='S2KFConverter'>\n" + elements + "</ConverterConfig>", "my.xml"));
}

std::string ErrorOf(const std::string& elements) {
  try {
    Read(elements);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(S2kfSettingsTest, AttributesAreReadInTheirUnit) {
  const S2kfSettings settings = Read(
      "<Filter type='ukf' root='rpy' limits='tanh'/>\n"
      "<Noise markerStandardDeviation_mm='2.5'/>\n<Start method='paper' recovery='false'/>");
  EXPECT_EQ(settings.filter, FilterType::kUkf);
  EXPECT_EQ(settings.root, RootParameters::kRpy);
  EXPECT_EQ(settings.limits, LimitFunction::kTanh);
  EXPECT_DOUBLE_EQ(settings.marker_deviation, 0.0025);
  EXPECT_EQ(settings.start, StartMethod::kPaper);
  EXPECT_FALSE(settings.recovery);
  EXPECT_EQ(settings.samples, S2kfSettings{}.samples);
}

TEST(S2kfSettingsTest, WhatCanNotBeIsAnErrorWithItsLine) {
  EXPECT_THAT(ErrorOf("<Filter samples='300'/>"), AllOf(HasSubstr("my.xml:2"), HasSubstr("odd")));
  EXPECT_THAT(ErrorOf("<Filter update='exact' iterations='2'/>"),
              AllOf(HasSubstr("my.xml:2"), HasSubstr("regression")));
  EXPECT_THAT(ErrorOf("\n<Filter kind='ekf'/>"), AllOf(HasSubstr("my.xml:3"), HasSubstr("type")));
  EXPECT_THAT(ErrorOf("<Filter type='pf'/>"), AllOf(HasSubstr("my.xml:2"), HasSubstr("ekf")));
  EXPECT_THAT(ErrorOf("<Noise markerStandardDeviation_mm='-1'/>"), HasSubstr("my.xml:2"));
  EXPECT_THAT(ErrorOf("<Noises/>"), AllOf(HasSubstr("my.xml:2"), HasSubstr("Noise")));
}

TEST(S2kfSettingsTest, ThePapersConfigurationIsThePapers) {
  const S2kfSettings paper = PaperSettings();
  constexpr double kPaperFrame = 0.01;  // [s]
  EXPECT_EQ(paper.filter, FilterType::kS2kf);
  EXPECT_EQ(paper.samples, 301);
  EXPECT_EQ(paper.update, UpdateForm::kExact);
  EXPECT_EQ(paper.iterations, 1);
  EXPECT_EQ(paper.root, RootParameters::kRpy);
  EXPECT_EQ(paper.limits, LimitFunction::kSine);
  EXPECT_EQ(paper.start, StartMethod::kPaper);
  EXPECT_FALSE(paper.recovery);
  EXPECT_EQ(paper.natural_spread, 0);
  EXPECT_EQ(paper.robust_distance, 0);
  // 25 mm^2, 1e-10 rad^2 and 1e-4 mm^2, to the rounding of their roots.
  EXPECT_NEAR(paper.noise.position * paper.noise.position * kPaperFrame, 25e-6, 1e-18);
  EXPECT_NEAR(paper.noise.orientation * paper.noise.orientation * kPaperFrame, 1e-10, 1e-23);
  EXPECT_NEAR(paper.noise.parameters * paper.noise.parameters * kPaperFrame, 1e-10, 1e-23);
  EXPECT_NEAR(paper.marker_deviation * paper.marker_deviation, 1e-10, 1e-23);
}

}  // namespace
}  // namespace mmm_converter::s2kf
