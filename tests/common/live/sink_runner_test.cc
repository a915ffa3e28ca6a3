// SPDX-License-Identifier: MIT
#include "common/live/sink_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <semaphore>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Notes frames; waits before each for the gate; fails at a frame.
class NotingSink : public PoseSink {
 public:
  struct Notes {
    std::vector<std::int64_t> frames;
    bool has_ended = false;
    std::counting_semaphore<> gate{0};
  };
  NotingSink(Notes* notes, bool needs_all, std::int64_t fails_at = -1)
      : notes_(notes), needs_all_(needs_all), fails_at_(fails_at) {}
  std::string name() const override { return "noting"; }
  void Write(const std::shared_ptr<const LiveBody>& /*body*/, const PoseFrame& frame) override {
    notes_->gate.acquire();
    if (frame.number == fails_at_) throw Error("the disk is full");
    notes_->frames.push_back(frame.number);
  }
  void End() override { notes_->has_ended = true; }
  bool needs_every_frame() const override { return needs_all_; }

 private:
  Notes* notes_;
  bool needs_all_;
  std::int64_t fails_at_;
};

PoseFrame Frame(std::int64_t number) {
  PoseFrame frame;
  frame.number = number;
  return frame;
}

TEST(SinkRunner, WritesInOrderAndEnds) {
  NotingSink::Notes notes;
  notes.gate.release(100);
  SinkRunner runner(std::make_unique<NotingSink>(&notes, false), 100, nullptr);
  for (int k = 0; k < 100; ++k) runner.Offer(nullptr, Frame(k), false);
  runner.Finish();
  std::vector<std::int64_t> all(100);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(notes.frames, all);
  EXPECT_TRUE(notes.has_ended);
  EXPECT_EQ(runner.lost(), 0);
  EXPECT_EQ(runner.written(), 100);
}

TEST(SinkRunner, ASlowSinkLosesFramesAndNobodyWaits) {
  NotingSink::Notes notes;
  SinkRunner runner(std::make_unique<NotingSink>(&notes, false), 4, nullptr);
  for (int k = 0; k < 10; ++k) runner.Offer(nullptr, Frame(k), true);
  EXPECT_EQ(runner.lost(), 6);
  notes.gate.release(100);
  runner.Finish();
  EXPECT_THAT(notes.frames, ElementsAre(0, 1, 2, 3));
}

TEST(SinkRunner, WhereTheSourceCanWaitNoFrameIsLost) {
  NotingSink::Notes notes;
  notes.gate.release(1000);
  SinkRunner runner(std::make_unique<NotingSink>(&notes, true), 2, nullptr);
  for (int k = 0; k < 500; ++k) runner.Offer(nullptr, Frame(k), true);
  runner.Finish();
  EXPECT_EQ(runner.lost(), 0);
  EXPECT_EQ(notes.frames.size(), 500U);
}

TEST(SinkRunner, ASinkThatFailsIsToldOnceAndGetsNoMore) {
  NotingSink::Notes notes;
  notes.gate.release(100);
  std::vector<std::string> failures;
  SinkRunner runner(std::make_unique<NotingSink>(&notes, true, 2), 100,
                    [&](const std::string& why) { failures.push_back(why); });
  for (int k = 0; k < 10; ++k) runner.Offer(nullptr, Frame(k), true);
  runner.Finish();
  EXPECT_THAT(failures, ElementsAre(HasSubstr("disk is full")));
  EXPECT_THAT(notes.frames, ElementsAre(0, 1));
  EXPECT_FALSE(notes.has_ended);
  EXPECT_TRUE(runner.has_failed());
}

}  // namespace
}  // namespace mmm_converter
