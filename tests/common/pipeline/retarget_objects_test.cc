// SPDX-License-Identifier: MIT
#include "common/pipeline/dynamics/retarget_objects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace mmm_converter {
namespace {

PoseTrajectory Frames(int count, double rate) {
  PoseTrajectory frames;
  frames.rate = rate;
  for (int k = 0; k < count; ++k) {
    frames.postures.emplace_back().position = {0.1 * k, 0, 1};
  }
  return frames;
}

RecordedObject WithGap(int begin, int end) {
  RecordedObject object;
  object.file = "cup.xml";
  object.recorded.name = "cup";
  object.recorded.trajectory = Frames(20, 100);
  for (int k = begin; k < end; ++k) {
    object.recorded.trajectory.postures[k].position.setConstant(
        std::numeric_limits<double>::quiet_NaN());
  }
  return object;
}

TEST(AlignObjects, KeepsTheLongestPartAndSaysWhatIsLeftOut) {
  Warnings warnings;
  auto objects = AlignObjects(Frames(20, 100), {WithGap(5, 7), WithGap(15, 20)}, &warnings);
  EXPECT_EQ(objects[0].begin, 7);
  EXPECT_EQ(objects[0].end, 20);
  // Of the last frame before a gap nothing behind it is needed.
  EXPECT_EQ(objects[1].begin, 0);
  EXPECT_EQ(objects[1].end, 15);
  ASSERT_EQ(warnings.all().size(), 1U);
  EXPECT_THAT(warnings.texts().front(),
              ::testing::AllOf(::testing::HasSubstr("\"cup\""),
                               ::testing::HasSubstr("0.07 to 0.19 s, 0.13 s of 0.18 s")));
  // Between two frames both are.
  objects = AlignObjects(Frames(39, 200), {WithGap(15, 20)}, &warnings);
  EXPECT_EQ(objects[0].end, 29);
  EXPECT_NEAR(objects[0].X_WO[27].translation().x(), 1.35, 1e-12);
}

}  // namespace
}  // namespace mmm_converter
