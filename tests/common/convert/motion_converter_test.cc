// SPDX-License-Identifier: MIT
#include "common/convert/motion_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/convert/tracking_start.h"
#include "common/support/error.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Says in the posture what it was asked for: x counts calls, y is dt; the joints turn by call / 10.
class RecordingConverter final : public MotionConverter {
 public:
  explicit RecordingConverter(const TrackingSetup& setup) : MotionConverter(setup) {
    estimate_.posture.joint_angles.setZero(2);
    estimate_.standard_deviations = Eigen::VectorXd::LinSpaced(8, 1, 8);
    estimate_.residuals = Eigen::Vector3d(0.01, 0.02, 0.03);
    estimate_.converged = true;
  }
  const FrameEstimate& Assemble(const Eigen::Ref<const Eigen::Matrix3Xd>& frame) override {
    calls_ = 0;
    return Answer(frame, -1);
  }
  const FrameEstimate& Track(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, double dt) override {
    return Answer(frame, dt);
  }

 private:
  const FrameEstimate& Answer(const Eigen::Ref<const Eigen::Matrix3Xd>& frame, double dt) {
    estimate_.posture.position = {static_cast<double>(calls_), dt, frame(0, 0)};
    estimate_.posture.joint_angles = Eigen::Vector2d(0.1, 0.2) * calls_;
    estimate_.markers_seen = 3;
    ++calls_;
    return estimate_;
  }

  int calls_ = 0;
  FrameEstimate estimate_;
};

class MotionConverterTest : public ::testing::Test {
 protected:
  static MarkerSequence MakeRecording(int frames, int first_seen, double rate = 100) {
    MarkerSequence recording({"A", "B", "C"}, frames, rate, 2.0);
    for (int k = 0; k < frames; ++k) {
      recording.frame(k).col(0) = Eigen::Vector3d(k, 0, 0);
      if (k < first_seen) continue;
      recording.frame(k).col(1) = Eigen::Vector3d(k, 1, 0);
      recording.frame(k).col(2) = Eigen::Vector3d(k, 0, 1);
    }
    return recording;
  }

  ConversionResult Convert(const MarkerSequence& recording,
                           const std::function<bool(int)>& progress = {}) {
    return converter_.Convert(recording, progress);
  }

  static TrackingSetup MakeSetup() {
    TrackingSetup setup{std::make_shared<const KinematicModel>(testing::StickModel()), {1}, {}};
    for (int i = 0; i < 3; ++i) setup.mapping.assignments.push_back({LabelIx(i), MarkerIx(i), 1});
    return setup;
  }

  RecordingConverter converter_{MakeSetup()};
};

TEST_F(MotionConverterTest, AssemblesTheFirstFrameAndTracksTheOthers) {
  const ConversionResult result = Convert(MakeRecording(3, 0));
  ASSERT_EQ(result.trajectory.num_frames(), 3);
  EXPECT_EQ(result.trajectory.postures[0].position, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(result.trajectory.postures[1].position, Eigen::Vector3d(1, 0.01, 1));
  EXPECT_EQ(result.trajectory.postures[2].position, Eigen::Vector3d(2, 0.01, 2));
  EXPECT_EQ(result.trajectory.rate, 100);
  EXPECT_EQ(result.trajectory.first_time, 2.0);
  EXPECT_TRUE(result.frames[2].converged);
  EXPECT_GE(result.frames[2].seconds, 0);
}

TEST_F(MotionConverterTest, KeepsTheTrackedJointsOnly) {
  const ConversionResult result = Convert(MakeRecording(3, 0));
  EXPECT_THAT(result.trajectory.joint_names, ElementsAre("hip"));
  EXPECT_THAT(result.trajectory.postures[2].joint_angles, ElementsAre(0.4));
  EXPECT_THAT(result.trajectory.standard_deviations.col(2), ElementsAre(1, 2, 3, 4, 5, 6, 8));
  EXPECT_THAT(result.residuals.col(1), ElementsAre(0.01, 0.02, 0.03));
}

TEST_F(MotionConverterTest, FramesBeforeTheFirstPostureTakeItUnconverged) {
  const ConversionResult result = Convert(MakeRecording(5, 2));
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(result.trajectory.postures[k].position, Eigen::Vector3d(0, -1, 2));
    EXPECT_FALSE(result.frames[k].converged);
    EXPECT_EQ(result.frames[k].markers_seen, 1);
    EXPECT_TRUE(result.residuals.col(k).array().isNaN().all());
  }
  EXPECT_TRUE(result.frames[2].converged);
  EXPECT_EQ(result.trajectory.postures[3].position.y(), 0.01);
}

TEST(TrackingStartTest, IsWhereAThirdIsSeenOrASecondShowsNoMore) {
  TrackingSetup setup;
  setup.mapping.assignments.resize(30);
  TrackingStart start(setup);
  EXPECT_FALSE(start.IsAt(0, 2));
  EXPECT_FALSE(start.IsAt(1, 4));
  EXPECT_FALSE(start.IsAt(1.5, 6));
  EXPECT_FALSE(start.IsAt(2, 5));  // six were seen
  EXPECT_FALSE(start.IsAt(2.1, 2));
  EXPECT_TRUE(start.IsAt(2.2, 6));
  EXPECT_FALSE(start.IsAt(3.5, 6));  // who was away comes anew
  EXPECT_TRUE(start.IsAt(3.6, 10));
}

TEST_F(MotionConverterTest, NeedsThreeMarkersInSomeFrame) {
  const ConversionResult late = Convert(MakeRecording(20, 15, 10));
  EXPECT_FALSE(late.frames[14].converged);
  EXPECT_TRUE(late.frames[15].converged);
  EXPECT_THAT([&] { Convert(MakeRecording(20, 20, 10)); },
              ThrowsMessage<Error>(HasSubstr("at most 1 of 3 are seen")));
  EXPECT_THAT([&] { Convert(MakeRecording(0, 0)); }, ThrowsMessage<Error>(HasSubstr("at most 0")));
}

TEST_F(MotionConverterTest, ReportsProgressAndCanBeCancelled) {
  std::vector<int> seen;
  Convert(MakeRecording(3, 0), [&](int k) {
    seen.push_back(k);
    return true;
  });
  EXPECT_THAT(seen, ElementsAre(1, 2, 3));
  EXPECT_THAT([&] { Convert(MakeRecording(3, 0), [](int k) { return k < 2; }); },
              ThrowsMessage<Error>("cancelled after 2 of 3 frames"));
}

}  // namespace
}  // namespace mmm_converter
