// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/convert/live_tracker.h"
#include "common/convert/plugin_loader.h"
#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/io/robot/robot_file.h"
#include "common/live/frame_mailbox.h"
#include "common/live/replay/replay_source.h"
#include "common/live/sink_runner.h"
#include "common/model/model_scaling.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/synthetic_motion.h"
#include "common/retarget/follow_figures.h"
#include "common/retarget/guarded_follower.h"
#include "common/support/data_directory.h"
#include "tests/support/shared_data.h"

// Sanitizers have an allocator of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

thread_local long allocations = 0;

}  // namespace

extern "C" void* __libc_malloc(std::size_t size);  // NOLINT(bugprone-reserved-identifier)

// Of the whole process, libraries too.
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace mmm_converter {
namespace {

class NoSink : public PoseSink {
 public:
  std::string name() const override { return "none"; }
  void Write(const std::shared_ptr<const LiveBody>& /*body*/, const PoseFrame& /*frame*/) override {
  }
};

TEST(LiveAllocation, TheTrackingThreadAllocatesNothing) {
  const auto reference =
      std::make_shared<const KinematicModel>(ReadMmmModel(DataFile("models/mmm.xml")));
  const LoadedPlugin plugin = LoadPluginByName("S2KFConverter");
  const ConverterConfig config =
      ParseConverterConfig(plugin.factory().config_template(), "default");
  MarkerSequence sample = ReadRecording(testing::SourcePath("examples/handstand.c3d"), {}).markers;
  auto body = std::make_shared<LiveBody>();
  body->setup = MakeTrackingSetup({.names = sample.labels(), .source = "sample"}, reference, config,
                                  {.size = WinterScaling{1.8, 70, {}}});
  LiveTracker tracker(plugin.factory().Create(body->setup, config), sample.rate());
  ReplaySource source(std::move(sample), 1, {.speed = 0, .loop = true}, "sample");
  SinkRunner sink(std::make_unique<NoSink>(), 64, nullptr);
  FrameMailbox box(false);
  PoseFrame pose;
  long counted = 0;
  for (int k = 0; k < 600; ++k) {
    // The first of all is a layout.
    if (source.Next(std::chrono::milliseconds(0), &box.next().frame) != StreamEvent::kFrame)
      continue;
    const long before = allocations;
    box.Put();
    const LaidOutFrame* frame = box.Take(std::chrono::milliseconds(0), 1);
    ASSERT_NE(frame, nullptr);
    const FrameEstimate* estimate = tracker.Track(frame->frame.points, frame->frame.time);
    ASSERT_NE(estimate, nullptr);
    pose.number = frame->frame.number;
    pose.is_tracking = true;
    pose.points = frame->frame.points;
    pose.estimate = *estimate;
    sink.Offer(body, pose, false);
    tracker.Prepare();
    // Each of the ring's frames gets its size once.
    if (k > 100) counted += allocations - before;
  }
  EXPECT_EQ(counted, 0);
  EXPECT_GT(allocations, 0);
}

TEST(LiveAllocation, ARobotThatFollowsAllocatesNothing) {
  const auto person = std::make_shared<const KinematicModel>(
      ScaleWinter(ReadMmmModel(DataFile("models/mmm.xml")), {1.8, 70, {}}));
  const Robot robot = ReadRobotFile(testing::SourcePath("examples/robot/biped.urdf"));
  const RobotBody body = FindRobotBody(robot, {}, {});
  GuardedFollower follower(person, robot, body, 100, {});
  FollowWatch watch(robot, body);
  const PoseTrajectory motion = MakeRaisedKnee(*person);
  std::vector<Posture> postures;
  for (int k = 0; k < motion.num_frames(); ++k) {
    postures.push_back(ModelPosture(*person, motion, k));
  }
  long counted = 0;
  // What touches for the first time gets its size: the second time round none is left.
  for (int k = 0; k < 2 * motion.num_frames(); ++k) {
    const int frame = k % motion.num_frames();
    const long before = allocations;
    const Posture& posture = follower.Follow(postures[frame], k / motion.rate);
    watch.Take(follower, posture, k / motion.rate);
    if (k >= motion.num_frames()) counted += allocations - before;
  }
  EXPECT_EQ(counted, 0);
}

}  // namespace
}  // namespace mmm_converter

#endif
