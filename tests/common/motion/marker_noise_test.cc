// SPDX-License-Identifier: MIT
#include "common/motion/marker_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/seeded_random.h"
#include "tests/support/all_indices.h"

namespace mmm_converter {
namespace {

// Two markers that swing by 0.3 m, in turns quick and slow.
MarkerSequence Swinging(double noise) {
  MarkerSequence markers({"A", "B"}, 400, 100, 0);
  SeededRandom random(1);
  for (int k = 0; k < markers.num_frames(); ++k) {
    for (int i = 0; i < 2; ++i) {
      const double phase = 3 * std::sin(0.01 * k + 2 * i);
      for (double& x : markers.frame(k).col(i)) x = 0.3 * std::sin(phase) + noise * random.Normal();
    }
  }
  return markers;
}

TEST(MarkerNoise, IsTheNoiseWhereMarkersMove) {
  // The quietest tenth of the windows, with 30 differences each, is some 20 % below the mean.
  for (const double noise : {0.0005, 0.005, 0.02}) {
    EXPECT_NEAR(MeasureMarkerNoise(Swinging(noise), testing::AllIndices<LabelIx>(2)), 0.8 * noise,
                0.15 * noise);
  }
  EXPECT_LT(MeasureMarkerNoise(Swinging(0), testing::AllIndices<LabelIx>(2)), 1e-4);
}

TEST(MarkerNoise, IsNotKnownWhereNothingIsSeen) {
  EXPECT_TRUE(std::isnan(
      MeasureMarkerNoise(MarkerSequence({"A"}, 100, 100, 0), testing::AllIndices<LabelIx>(1))));
  EXPECT_TRUE(
      std::isnan(MeasureMarkerNoise(Swinging(0).Slice(0, 5), testing::AllIndices<LabelIx>(2))));
}

}  // namespace
}  // namespace mmm_converter
