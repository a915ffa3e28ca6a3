// SPDX-License-Identifier: MIT
// The baseline as a plugin of the real binary, on the shipped sample.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "common/io/mmm/mmm_motion.h"
#include "tests/cli/program.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::Handstand;
using ::testing::HasSubstr;
using testing::ReadText;
using testing::RunProgram;
using testing::TestFolder;

nlohmann::json ConvertSample(const std::vector<std::string>& more) {
  const std::string summary = TestFolder() + "/summary.json";
  std::vector<std::string> arguments = {"convert",   Handstand(), "--height",
                                        "1.8",       "-o",        TestFolder() + "/o.xml",
                                        "--summary", summary};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto run = RunProgram(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return nlohmann::json::parse(ReadText(summary));
}

std::string Shipped(const std::string& name) {
  return testing::SourcePath("xml_config/converters/" + name + ".xml");
}

TEST(Jacobian, ConvertsTheSampleWithoutAConfiguration) {
  const std::string csv = TestFolder() + "/o.csv";
  const auto json = ConvertSample({"--converter", "JacobianConverter", "--export-csv", csv});
  EXPECT_EQ(json["converter"], "JacobianConverter");
  EXPECT_EQ(json["frames"], 675);
  // In the two quickest frames the fit ends at its most iterations.
  EXPECT_EQ(json["frames_not_converged"], 2);
  EXPECT_NEAR(json["distance_mm"]["mean"].get<double>(), 37.73, 0.02);  // the sample's optimum
  EXPECT_EQ(ReadMmmMotionFile(TestFolder() + "/o.xml").motions.at(0).trajectory.num_frames(), 675);
  // No standard deviations: cells are empty.
  const std::string table = ReadText(csv);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 676);
  EXPECT_THAT(table, HasSubstr("sd_LKx_joint_rad"));
  EXPECT_THAT(table, HasSubstr(",,,\n"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("nan")));
}

TEST(Jacobian, ShippedConfigurationsDoWhatTheyAreFor) {
  const auto mean = [](const std::string& name) {
    return ConvertSample({"-c", Shipped(name)})["distance_mm"]["mean"].get<double>();
  };
  const double least_squares = mean("jacobian_least_squares");
  EXPECT_NEAR(least_squares, 37.73, 0.02);
  EXPECT_NEAR(mean("jacobian_pull"), least_squares, 0.15);
  const double gradient = mean("jacobian_gradient");
  // It lags in the quick parts and has nearly the optimum elsewhere.
  EXPECT_GT(gradient, least_squares + 1);
  EXPECT_LT(gradient, 1.15 * least_squares);
}

}  // namespace
}  // namespace mmm_converter
