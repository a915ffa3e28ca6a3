// SPDX-License-Identifier: MIT
#include "common/motion/flat_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace mmm_converter {
namespace {

TEST(FlatFramesTest, AllMarkersAreLowAndStill) {
  MarkerSequence recording({"heel", "toe"}, 40, 100, 0);
  for (int k = 0; k < 40; ++k) {
    // The heel rises from frame 20 on, the toe from frame 30 on.
    recording.frame(k).col(0) << 0, 0, 0.05 + 0.01 * std::max(0, k - 20);
    recording.frame(k).col(1) << 0.2, 0, 0.03 + 0.01 * std::max(0, k - 30);
  }
  recording.frame(7)(2, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<int> flat = FlatFrames(recording, {0, 1});
  EXPECT_THAT(flat,
              ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19));
  EXPECT_THAT(FlatFrames(recording, {}), ::testing::IsEmpty());
}

}  // namespace
}  // namespace mmm_converter
