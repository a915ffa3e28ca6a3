// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;
using Json = nlohmann::json;

const Json& Row(const Json& experiment, const std::string& trial, const std::string& contender) {
  for (const Json& row : experiment["rows"]) {
    if (row["trial"] == trial && row["contender"] == contender) return row;
  }
  ADD_FAILURE() << "no row " << contender << " on " << trial;
  return experiment;
}

double Mean(const Json& row) { return row["distance_mm"]["mean"]; }

constexpr const char* kHandstand = "handstand, 100 Hz";

void ExpectCompleteDataFavoursTheOptimum(const Json& complete) {
  const double least_squares = Mean(Row(complete, kHandstand, "jacobian_least_squares"));
  // No tracker is below the frame's optimum in squares; in mean distance it may be by a little.
  constexpr double kTolerance = 0.02;
  for (const char* filter : {"s2kf_default", "s2kf_paper", "ukf", "ekf"}) {
    EXPECT_LE(least_squares, Mean(Row(complete, kHandstand, filter)) + kTolerance) << filter;
  }
  EXPECT_NEAR(least_squares, complete["trials"][0]["optimum_mm"], kTolerance);
  // The gradient lags where joints are fast, and has nearly the optimum elsewhere.
  const Json& gradient = Row(complete, kHandstand, "jacobian_gradient");
  const double worst_of_least_squares =
      Row(complete, kHandstand, "jacobian_least_squares")["distance_mm"]["worst_frame"];
  EXPECT_GT(gradient["distance_mm"]["worst_frame"].get<double>(), 1.3 * worst_of_least_squares);
  EXPECT_GT(Mean(gradient), least_squares);
  EXPECT_LT(Mean(gradient), 1.15 * least_squares);
}

void ExpectOcclusionFavoursTheFilter(const Json& occlusion) {
  const Json& filter = Row(occlusion, kHandstand, "s2kf_default");
  const Json& fit = Row(occlusion, kHandstand, "jacobian_least_squares");
  EXPECT_LT(Mean(filter), Mean(fit));
  EXPECT_LT(filter["distance_mm"]["worst_frame"], fit["distance_mm"]["worst_frame"]);
  EXPECT_EQ(filter["runs"].size(), 2);
}

void ExpectSamplingPaysAtLowRates(const Json& rates) {
  EXPECT_NEAR(Mean(Row(rates, kHandstand, "s2kf")), Mean(Row(rates, kHandstand, "ekf")), 0.1);
  EXPECT_LT(Mean(Row(rates, "handstand, 10 Hz", "s2kf")),
            Mean(Row(rates, "handstand, 10 Hz", "ekf")));
  EXPECT_LT(Mean(Row(rates, "handstand, 5 Hz", "s2kf")),
            0.7 * Mean(Row(rates, "handstand, 5 Hz", "ekf")));
}

TEST(Evaluate, ShowsWhatTheFilterGainsAndWhatNot) {
  const std::string folder = TestFolder() + "/results/deep";
  const auto run = RunProgram({"evaluate", "--repeat", "2", "-o", folder});
  EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_THAT(run.out, HasSubstr("| handstand | paper | here"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/occlusion.gp"));
  const Json results = Json::parse(ReadText(folder + "/evaluation.json"));
  EXPECT_EQ(results["complete"]["trials"][0]["compared_markers"], 50);
  EXPECT_EQ(results["complete"]["trials"][0]["compared_joints"], 40);
  ExpectCompleteDataFavoursTheOptimum(results["complete"]);
  ExpectOcclusionFavoursTheFilter(results["occlusion"]);
  ExpectSamplingPaysAtLowRates(results["rates"]);
}

TEST(Evaluate, SaysWhereItCantWrite) {
  const auto run = RunProgram({"evaluate", "-o", "/dev/null/results"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("/dev/null/results"));
}

}  // namespace
}  // namespace mmm_converter
