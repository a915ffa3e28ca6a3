// SPDX-License-Identifier: MIT
#include "common/live/latency_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mmm_converter {
namespace {

TEST(LatencyHistogram, QuantilesAreAtMostTwoPercentAbove) {
  LatencyHistogram histogram;
  EXPECT_TRUE(std::isnan(histogram.Quantile(0.5)));
  for (int i = 1; i <= 1000; ++i) histogram.Add(1e-5 * i);
  EXPECT_EQ(histogram.count(), 1000);
  EXPECT_DOUBLE_EQ(histogram.longest(), 1e-2);
  for (const double share : {0.01, 0.5, 0.99, 1.0}) {
    EXPECT_GE(histogram.Quantile(share), share * 1e-2 * (1 - 1e-9));
    EXPECT_LE(histogram.Quantile(share), share * 1e-2 * 1.02 * (1 + 1e-9));
  }
}

TEST(LatencyHistogram, TakesTimesBeyondItsBounds) {
  LatencyHistogram histogram;
  histogram.Add(-1);
  histogram.Add(0);
  histogram.Add(1e6);
  EXPECT_EQ(histogram.count(), 3);
  EXPECT_DOUBLE_EQ(histogram.longest(), 1e6);
  EXPECT_LE(histogram.Quantile(0.5), 1.1e-6);
}

}  // namespace
}  // namespace mmm_converter
