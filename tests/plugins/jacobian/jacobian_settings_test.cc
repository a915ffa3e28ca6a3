// SPDX-License-Identifier: MIT
#include "plugins/jacobian/jacobian_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/error.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::jacobian {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

JacobianSettings Read(const std::string& inside) {
  return ReadSettings(ParseConverterConfig(
      "<ConverterConfig type='JacobianConverter'>\n" + inside + "\n</ConverterConfig>", "my.xml"));
}

TEST(JacobianSettings, AreReadInTheUnitsThatTheirNamesSay) {
  const JacobianSettings settings = Read(
      "<Method type='gradient' robustDistance_mm='80'/>"
      "<Gradient steps='7' damping_mm_per_rad='20' stepLimit_rad='0.5'/>");
  EXPECT_EQ(settings.method, Method::kGradient);
  EXPECT_DOUBLE_EQ(settings.robust_distance, 0.08);
  EXPECT_EQ(settings.steps, 7);
  EXPECT_DOUBLE_EQ(settings.damping, 0.02);
  EXPECT_DOUBLE_EQ(settings.step_limit, 0.5);
}

TEST(JacobianSettings, AllErrorsAreToldWithFileAndLine) {
  try {
    Read("<Method type='newton'/>\n<Gradient steps='0'/>\n<Filter/>");
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("my.xml:2:"), HasSubstr("leastSquares or gradient"),
                                    HasSubstr("my.xml:3:"), HasSubstr("my.xml:4:")));
  }
}

TEST(JacobianSettings, ShippedConfigurationsSayWhatTheyAreNamed) {
  const auto shipped = [](const std::string& name) {
    return ReadSettings(
        ReadConverterConfig(testing::SourcePath("xml_config/converters/" + name + ".xml")));
  };
  EXPECT_EQ(shipped("jacobian_gradient").method, Method::kGradient);
  EXPECT_EQ(shipped("jacobian_least_squares").method, Method::kLeastSquares);
  EXPECT_EQ(shipped("jacobian_least_squares").previous_weight, 0);
  EXPECT_GT(shipped("jacobian_pull").previous_weight, 0);
  EXPECT_EQ(shipped("jacobian_opensim").natural_weight, 0);
  EXPECT_LT(shipped("jacobian_opensim").tolerance, 1e-10);
}

}  // namespace
}  // namespace mmm_converter::jacobian
