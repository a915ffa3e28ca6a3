// SPDX-License-Identifier: MIT
#include "common/live/replay/replay_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/support/error.h"
#include "tests/common/live/live_samples.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;

MarkerSequence ThreeFrames() {
  MarkerSequence recording({"a", "b"}, 3, 100, 2.5);
  for (int k = 0; k < 3; ++k) recording.frame(k).col(0).setConstant(k);
  return recording;
}

TEST(ReplaySource, GivesEveryFrameWithItsNumberAndTime) {
  ReplaySource source(ThreeFrames(), 7, {.speed = 0}, "walk.c3d");
  EXPECT_TRUE(source.waits_for_reader());
  StreamFrame frame;
  ASSERT_EQ(source.Next(milliseconds(0), &frame), StreamEvent::kLayout);
  EXPECT_EQ(source.layout().labels, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(source.layout().rate, 100);
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(source.Next(milliseconds(0), &frame), StreamEvent::kFrame);
    EXPECT_EQ(frame.number, 7 + k);
    EXPECT_EQ(frame.time, 2.5 + k / 100.0);
    EXPECT_EQ(frame.points(0, 0), k);
    EXPECT_TRUE(std::isnan(frame.points(0, 1)));
  }
  EXPECT_EQ(source.Next(milliseconds(0), &frame), StreamEvent::kEnd);
  EXPECT_EQ(source.counts().frames, 3);
}

TEST(ReplaySource, ALoopStartsWithALayoutAfterAGapAndCountsOn) {
  ReplaySource source(ThreeFrames(), 1, {.speed = 0, .loop = true}, "walk.c3d");
  StreamFrame frame;
  for (int k = 0; k < 4; ++k) source.Next(milliseconds(0), &frame);
  ASSERT_EQ(source.Next(milliseconds(0), &frame), StreamEvent::kLayout);
  ASSERT_EQ(source.Next(milliseconds(0), &frame), StreamEvent::kFrame);
  EXPECT_EQ(frame.number, 4);
  EXPECT_DOUBLE_EQ(frame.time, 2.53 + 0.5);
  EXPECT_EQ(frame.points(0, 0), 0);
  source.Next(milliseconds(0), &frame);
  EXPECT_DOUBLE_EQ(frame.time, 2.54 + 0.5);
}

TEST(ReplaySource, FramesAreDueInTheRecordingsTimeToTheMicrosecond) {
  testing::TestClock clock;
  MarkerSequence recording({"a"}, 3, 1600, 0);
  ReplaySource source(recording, 1, {.loop = true, .now = clock.Now()}, "walk.c3d");
  EXPECT_FALSE(source.waits_for_reader());
  std::vector<StreamEvent> events;
  StreamFrame frame;
  for (int k = 0; k < 4; ++k) {  // 1/1600 s each
    for (const int time : {624, 1}) {
      for (int i = 0; i < 2; ++i) events.push_back(source.Next(milliseconds(0), &frame));
      clock.GoOn(std::chrono::microseconds(time));
    }
  }
  using enum StreamEvent;
  EXPECT_THAT(events, ElementsAre(kLayout, kFrame, kNothing, kNothing,   //
                                  kFrame, kNothing, kNothing, kNothing,  //
                                  kFrame, kLayout, kNothing, kNothing,   //
                                  kFrame, kNothing, kNothing, kNothing));
  EXPECT_EQ(frame.number, 4);
}

TEST(ReplayAddress, Speeds) {
  EXPECT_EQ(ParseReplayAddress("walk.c3d").speed, 1);
  EXPECT_EQ(ParseReplayAddress("walk.c3d@2.5").speed, 2.5);
  EXPECT_EQ(ParseReplayAddress("walk.c3d@2.5").file, "walk.c3d");
  EXPECT_EQ(ParseReplayAddress("walk.c3d@max").speed, 0);
  for (const char* text : {"walk.c3d@0", "walk.c3d@-1", "walk.c3d@fast", "walk.c3d@nan", "a@"}) {
    EXPECT_THROW(ParseReplayAddress(text), Error) << text;
  }
}

TEST(ReplayAddress, AFileMayHaveTheSignInItsName) {
  const std::string file = testing::TestFolder() + "/walk@home.c3d";
  std::ofstream(file) << "x";
  EXPECT_EQ(ParseReplayAddress(file).file, file);
}

}  // namespace
}  // namespace mmm_converter
