// SPDX-License-Identifier: MIT
#include "common/math/statistics.h"
#include "common/support/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mmm_converter {
namespace {

TEST(Statistics, KnownValues) {
  const std::vector<double> values = {4, 1, kNaN, 3, 2};
  EXPECT_EQ(Mean(values), 2.5);
  EXPECT_EQ(Max(values), 4);
  EXPECT_EQ(Median(values), 2.5);
  EXPECT_EQ(Percentile(values, 0), 1);
  EXPECT_EQ(Percentile(values, 100), 4);
  EXPECT_DOUBLE_EQ(Percentile(values, 90), 3.7);  // place 2.7 of 0..3
  EXPECT_DOUBLE_EQ(Percentile(values, 10), 1.3);
}

TEST(Statistics, OneValueIsEveryPercentile) {
  const std::vector<double> values = {kNaN, 7, kNaN};
  for (const double percent : {0.0, 12.5, 50.0, 99.0, 100.0}) {
    EXPECT_EQ(Percentile(values, percent), 7);
  }
}

TEST(Statistics, NothingIsNaN) {
  for (const std::vector<double>& values : {std::vector<double>{}, {kNaN, kNaN}}) {
    EXPECT_TRUE(std::isnan(Mean(values)));
    EXPECT_TRUE(std::isnan(Max(values)));
    EXPECT_TRUE(std::isnan(Percentile(values, 95)));
  }
}

TEST(StatisticsTest, ChiSquareQuantilesAreThoseOfTables) {
  // Abramowitz, Stegun, table 26.8, to its digits.
  EXPECT_NEAR(ChiSquareQuantile(0.95, 1), 3.84146, 1e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.025, 10), 3.24697, 1e-5);
  EXPECT_NEAR(ChiSquareQuantile(0.975, 100), 129.561, 1e-3);
  // Of two degrees it is -2 ln(1 - p).
  EXPECT_NEAR(ChiSquareQuantile(0.3, 2), -2 * std::log(0.7), 1e-14);
}

}  // namespace
}  // namespace mmm_converter
