// SPDX-License-Identifier: MIT
#include "common/label/learn/learn_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Two labels 0.2 m apart, which go along together; the third swings by 0.1 m. At 100 Hz.
MarkerSequence Swing(const std::vector<std::string>& labels, int frames) {
  MarkerSequence recording(labels, frames, 100, 0);
  for (int k = 0; k < frames; ++k) {
    recording.frame(k).col(0) << 0.01 * k, 0, 0;
    recording.frame(k).col(1) << 0.01 * k, 0.2, 0;
    recording.frame(k).col(2) << 0.01 * k, 0.5 + 0.1 * std::sin(0.1 * k), 0;
  }
  return recording;
}

TEST(LearnFramesTest, LabelsOfAllRecordingsAreThereOnce) {
  const MarkerSequence a = Swing({"a", "b", "c"}, 10), b = Swing({"c", "d", "a"}, 10);
  const CommonLabels labels = FindCommonLabels({&a, &b});
  EXPECT_EQ(labels.names, (std::vector<std::string>{"a", "b", "c", "d"}));
  EXPECT_EQ(labels.columns[0], (std::vector<int>{0, 1, 2, -1}));
  EXPECT_EQ(labels.columns[1], (std::vector<int>{2, -1, 0, 1}));
}

TEST(LearnFramesTest, FramesAreSharedByTheLengthOfTheRecordings) {
  const MarkerSequence a = Swing({"a", "b", "c"}, 400), b = Swing({"a", "b", "c"}, 200);
  const auto frames = ChooseLearnFrames({&a, &b}, FindCommonLabels({&a, &b}));
  EXPECT_EQ(frames.size(), 60U);
  int of_first = 0;
  for (const LearnFrame& frame : frames) of_first += frame.recording == 0 ? 1 : 0;
  EXPECT_EQ(of_first, 40);
}

TEST(LearnFramesTest, OfEachPartTheFrameThatShowsMostIsTaken) {
  MarkerSequence recording = Swing({"a", "b", "c"}, 120);  // parts of two frames
  for (int k = 0; k < 120; k += 2) recording.frame(k).col(1).setConstant(kNaN);
  for (const LearnFrame& frame : ChooseLearnFrames({&recording}, FindCommonLabels({&recording}))) {
    EXPECT_EQ(SeenPoints(frame).cols(), 3);
  }
}

TEST(LearnFramesTest, WhatIsNotSeenIsNoPoint) {
  LearnFrame frame;
  frame.z.setConstant(3, 4, kNaN);
  frame.z.col(2) << 1, 2, 3;
  EXPECT_EQ(SeenPoints(frame), Eigen::Vector3d(1, 2, 3));
}

TEST(LearnFramesTest, DistancesThatAreKeptHaveNoDeviation) {
  const MarkerSequence recording = Swing({"a", "b", "c"}, 600);
  auto frames = ChooseLearnFrames({&recording}, FindCommonLabels({&recording}));
  const Eigen::MatrixXd deviations = DistanceDeviations(frames);
  EXPECT_LT(deviations(0, 1), 1e-12);
  EXPECT_NEAR(deviations(0, 2), 0.06, 0.003);  // percentiles of a sine, as of a normal deviate
  EXPECT_EQ(deviations, deviations.transpose());
  for (LearnFrame& frame : frames) frame.z.col(1).setConstant(kNaN);
  EXPECT_GT(DistanceDeviations(frames)(0, 1), 1e6);  // not known
}

TEST(LearnFramesTest, ALabelIsComparedWithTheTwoThatKeepTheirDistancesBest) {
  Eigen::MatrixXd deviations = Eigen::MatrixXd::Zero(4, 4);
  deviations.row(0) << 0, 0.004, 0.002, 0.09;
  const std::vector<int> sites = {1, 1, 1, 1};
  EXPECT_DOUBLE_EQ(*DeviationFrom(1, 0, sites, deviations), 0.003);
  EXPECT_DOUBLE_EQ(*DeviationFrom(2, 0, {1, 1, 1, 2}, deviations), 0.09);
  EXPECT_FALSE(DeviationFrom(3, 0, sites, deviations).has_value());
}

TEST(LearnFramesTest, GroupsAreLinkedByDistancesThatAreKept) {
  Eigen::MatrixXd deviations = Eigen::MatrixXd::Constant(5, 5, 0.05);
  deviations(0, 2) = deviations(2, 0) = 0.003;
  deviations(2, 3) = deviations(3, 2) = 0.003;
  deviations(1, 4) = deviations(4, 1) = 0.003;
  const auto groups = RigidGroups({1, 1, 1, 1, 2}, deviations);
  EXPECT_EQ(groups, (std::vector<std::vector<int>>{{0, 2, 3}, {1}, {4}}));
  EXPECT_TRUE(RigidGroups({-1, -1, -1, -1, -1}, deviations).empty());
}

}  // namespace
}  // namespace mmm_converter
