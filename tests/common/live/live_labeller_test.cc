// SPDX-License-Identifier: MIT
// Persons whose points have no names, frame by frame; the truth is known to the point.

#include "common/pipeline/live/live_labeller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "common/support/error.h"
#include "common/support/units.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/unnamed_points.h"

namespace mmm_converter::testing {
namespace {

constexpr double kHeight = 1.78;

class LiveLabellerTest : public ::testing::Test {
 protected:
  LiveLabellerTest() {
    const KinematicModel model = ScaledReferenceModel(kHeight);
    Subject subject = DrawPerson(model, 921);
    for (MarkerOffset& offset : subject.offsets) {
      offset.standard_deviations.setConstant(0.005);
      offset.skin_deviation = 0.004;
    }
    const KinematicModel person = FitToSubject(model, subject);
    recording_ = RecordPerson(person, RangeOfMotion(model, 2, 0.6, 921), 921);
    const auto assignments = AssignAll(model, recording_);
    calibrated_ = SetupOf(person, TrackedJoints(model), assignments);
    uncalibrated_ = SetupOf(model, TrackedJoints(model), assignments);
    made_ = MakeUnnamed(recording_, {.hidden = 0.05, .ghosts = 3}, 7);
    named_.setConstant(3, recording_.num_labels(), kNaN);
  }

  // Frame k of the recording at a time; half of the points under labels, which mean nothing.
  void Name(LiveLabeller* labeller, int k, double time, int points = 1000) {
    StreamFrame frame;
    frame.number = k;
    frame.time = time;
    const Eigen::Matrix3Xd all =
        made_.points.frame(k).leftCols(std::min<Eigen::Index>(points, made_.points.num_labels()));
    const Eigen::Index half = all.cols() / 2;
    frame.points = all.leftCols(half);
    SetUnnamed(static_cast<std::size_t>(all.cols() - half), &frame);
    frame.unnamed_points.leftCols(frame.unnamed) = all.rightCols(frame.unnamed);
    labeller->Name(frame, &named_);
    for (int label = 0; label < recording_.num_labels(); ++label) {
      if (!IsSeen(named_.col(label))) continue;
      const bool is_right = named_.col(label) == recording_.frame(k).col(label);
      (is_right ? right_ : wrong_) += 1;
    }
    const auto& truth = made_.truth[static_cast<std::size_t>(k)];
    markers_ += static_cast<int>(
        std::count_if(truth.begin(), truth.end(), [](int label) { return label >= 0; }));
  }

  void Forget() { right_ = wrong_ = markers_ = 0; }

  MarkerSequence recording_;
  TrackingSetup calibrated_, uncalibrated_;
  UnnamedPoints made_;
  Eigen::Matrix3Xd named_;
  int right_ = 0, wrong_ = 0, markers_ = 0;
};

TEST_F(LiveLabellerTest, NamesComeFromTheSecondFrameOn) {
  LiveLabeller labeller(calibrated_, true);
  Name(&labeller, 0, 100);
  EXPECT_EQ(right_ + wrong_, 0);
  EXPECT_FALSE(labeller.is_following());
  Forget();
  for (int k = 1; k < recording_.num_frames(); ++k) Name(&labeller, k, 100 + 0.01 * k);
  EXPECT_TRUE(labeller.is_following());
  EXPECT_GE(right_, 0.98 * markers_);  // the hidden blocks' ends; see common/label
  EXPECT_LE(wrong_, 0.005 * markers_);
}

TEST_F(LiveLabellerTest, WhoLeavesAndReturnsIsFoundAgain) {
  LiveLabeller labeller(calibrated_, true);
  for (int k = 0; k < 40; ++k) Name(&labeller, k, 0.01 * k);
  ASSERT_TRUE(labeller.is_following());
  for (int k = 40; k < 340; ++k) Name(&labeller, 40, 0.01 * k, 0);  // nobody for 3 s
  EXPECT_FALSE(labeller.is_following());
  Name(&labeller, 150, 3.41);
  Forget();
  for (int k = 151; k < 200; ++k) Name(&labeller, k, 3.41 + 0.01 * (k - 150));
  EXPECT_GE(right_, 0.98 * markers_);
  EXPECT_LE(wrong_, 0.005 * markers_);
}

TEST_F(LiveLabellerTest, TimeThatRunsBackBeginsAnew) {
  LiveLabeller labeller(calibrated_, true);
  for (int k = 0; k < 5; ++k) Name(&labeller, k, 50 + 0.01 * k);
  ASSERT_TRUE(labeller.is_following());
  Forget();
  Name(&labeller, 120, 1);
  EXPECT_EQ(right_ + wrong_, 0);
  Name(&labeller, 121, 1.01);
  EXPECT_GE(right_, 40);
  EXPECT_EQ(wrong_, 0);
}

TEST_F(LiveLabellerTest, ACalibratedBodyTakesOver) {
  LiveLabeller labeller(uncalibrated_, true);
  for (int k = 0; k < 50; ++k) Name(&labeller, k, 0.01 * k);
  labeller.Use(calibrated_);
  EXPECT_TRUE(labeller.is_following());
  for (int k = 50; k < 60; ++k) Name(&labeller, k, 0.01 * k);
  Forget();
  for (int k = 60; k < 200; ++k) Name(&labeller, k, 0.01 * k);
  EXPECT_GE(right_, 0.98 * markers_);
  EXPECT_LE(wrong_, 0.01 * markers_);  // neighbours that had exchanged their names before
}

TEST_F(LiveLabellerTest, WithoutWaitingItIsFoundMeanwhile) {
  LiveLabeller labeller(calibrated_, false);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  double time = 0;  // of frames of who stands still, a million a second however slow the machine is
  for (; !labeller.is_following() && std::chrono::steady_clock::now() < end; time += 1e-6) {
    Name(&labeller, 0, time);
    std::this_thread::yield();
  }
  EXPECT_TRUE(labeller.is_following()) << time;
  for (int k = 1; k < 50; ++k) Name(&labeller, k, time + 0.01 * k);
  EXPECT_TRUE(labeller.is_following());
  Forget();
  Name(&labeller, 50, time + 0.5);
  EXPECT_GE(right_, 0.95 * markers_);
}

TEST_F(LiveLabellerTest, AFewMarkersAreNoBody) {
  TrackingSetup few = calibrated_;
  few.mapping.assignments.resize(9);
  EXPECT_THROW(LiveLabeller(few, true), Error);
}

}  // namespace
}  // namespace mmm_converter::testing
