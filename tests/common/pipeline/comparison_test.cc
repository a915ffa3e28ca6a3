// SPDX-License-Identifier: MIT
#include "common/pipeline/comparison/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/motion/marker_synthesis.h"
#include "common/study/optimal_fit.h"
#include "tests/support/stick_model.h"
#include "tests/support/test_plugins.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Small sums of numbers around 1.
constexpr double kRounding = 1e-12;

// The TestConverter stands the model, unrotated, on the mean of the seen markers.
Contender MakeContender(const std::string& name, const std::string& labels, double offset_mm = 0) {
  Contender contender;
  contender.name = name;
  std::string mappings;
  for (const char label : labels) {
    mappings += std::string("<Mapping source='") + label + "' target='MARKER_" + label + "'/>";
  }
  contender.config = ParseConverterConfig(
      "<ConverterConfig type='TestConverter'><Model name='None'><MarkerMapping>" + mappings +
          "</MarkerMapping></Model><Test heightOffset_mm='" + std::to_string(offset_mm) +
          "'/></ConverterConfig>",
      name);
  contender.plugin = std::make_shared<LoadedPlugin>(testing::TestPlugin("test_converter"));
  return contender;
}

// A still stick, seen exactly where its model's markers are.
Trial MakeTrial(int frames) {
  Trial trial;
  trial.name = "still";
  trial.model = std::make_shared<KinematicModel>(testing::StickModel());
  trial.markers = MarkerSequence({"A", "B", "C", "D"}, frames, 100, 0);
  for (int k = 0; k < frames; ++k) {
    trial.markers.frame(k) << 0.1, 0, 0, 0,  //
        0, 0.1, 0, 0,                        //
        0, 0, 0.7, 1.3;
  }
  return trial;
}

Comparison CompareOn20Frames(std::vector<Contender> contenders,
                             const ComparisonOptions& options = {}) {
  return Compare({MakeTrial(20)}, std::move(contenders), options, nullptr);
}

TEST(Comparison, MeasuresWhatAConverterDoes) {
  const Comparison comparison = CompareOn20Frames({MakeContender("plain", "ABCD")});
  ASSERT_EQ(comparison.rows.size(), 1);
  const ComparisonRow& row = comparison.rows.front();
  ASSERT_EQ(row.failure, "");
  // The root is at the mean of the markers instead of 0: every marker is off by that much.
  const double off = Eigen::Vector3d(0.025, 0.025, 0.5).norm();
  EXPECT_NEAR(row.quality.all.mean, off, kRounding);
  EXPECT_NEAR(row.quality.all.max, off, kRounding);
  EXPECT_NEAR(row.mean_distance[19], off, kRounding);
  EXPECT_EQ(row.quality.lost_frames, 20);
  EXPECT_EQ(row.result.trajectory.num_frames(), 20);
  // The stick's own posture fits exactly; the weak pull to natural angles is at rest there.
  EXPECT_LT(comparison.grounds.front().optimum.maxCoeff(), 1e-6);
}

TEST(Comparison, OnlyMarkersAndJointsThatAllUseAreCompared) {
  Contender hip_only = MakeContender("bcd", "BCD");
  hip_only.config.joints = {{"hip", 1}};
  const Comparison comparison = CompareOn20Frames({MakeContender("abc", "ABC"), hip_only});
  EXPECT_THAT(comparison.grounds.front().labels, ElementsAre(1, 2));
  EXPECT_THAT(comparison.grounds.front().markers, ElementsAre(1, 2));
  EXPECT_THAT(comparison.grounds.front().joints, ElementsAre(1));
  EXPECT_EQ(comparison.row(0, 0).distances.rows(), 2);
}

TEST(Comparison, WithoutACommonMarkerThereIsNoComparison) {
  Trial trial = MakeTrial(5);
  trial.markers = MarkerSequence({"A", "B", "C", "D", "E", "F"}, 5, 100, 0);
  for (int k = 0; k < 5; ++k) trial.markers.frame(k).setZero();
  Contender other = MakeContender("def", "D");
  other.config.marker_pairs = {{"E", "MARKER_A"}, {"F", "MARKER_B"}, {"D", "MARKER_C"}};
  const Comparison comparison = Compare({trial}, {MakeContender("abc", "ABC"), other}, {}, nullptr);
  EXPECT_EQ(comparison.num_failures(), 2);
  EXPECT_THAT(comparison.rows[0].failure, HasSubstr("no marker is used by all"));
}

TEST(Comparison, FailuresAreRowsAndTheOthersRun) {
  Contender absent = MakeContender("absent", "ABCD");
  absent.failure = "no such plugin";
  Contender wrong = MakeContender("wrong", "ABCD");
  wrong.config.plugin_elements.clear();
  wrong.config.joints = {{"elbow", 3}};
  Trial unread;
  unread.failure = "no such file";
  const Comparison comparison =
      Compare({unread, MakeTrial(5)}, {absent, MakeContender("good", "ABCD"), wrong}, {}, nullptr);
  EXPECT_EQ(comparison.num_failures(), 5);
  EXPECT_EQ(comparison.row(0, 1).failure, "no such file");
  EXPECT_EQ(comparison.row(1, 0).failure, "no such plugin");
  EXPECT_EQ(comparison.row(1, 1).failure, "");
  EXPECT_GT(comparison.row(1, 1).quality.all.mean, 0);
  EXPECT_THAT(comparison.row(1, 2).failure, HasSubstr("elbow"));
}

TEST(Comparison, AConverterThatThrowsIsARow) {
  Trial unseen = MakeTrial(3);
  for (int k = 0; k < 3; ++k) unseen.markers.frame(k).leftCols(3).setConstant(std::nan(""));
  const Comparison comparison = Compare({unseen}, {MakeContender("plain", "ABCD")}, {}, nullptr);
  EXPECT_NE(comparison.rows.front().failure, "");
}

TEST(Comparison, ErrorsAreTakenOverHiddenMarkersToo) {
  ComparisonOptions options;
  options.hiding = {HidingModel::kStationary, 0.25, 5};
  const Comparison comparison = CompareOn20Frames({MakeContender("plain", "ABCD")}, options);
  const ComparisonRow& row = comparison.rows.front();
  ASSERT_EQ(row.failure, "");
  EXPECT_TRUE(row.distances.allFinite());
  EXPECT_EQ(comparison.grounds.front().hidden.count(), 20);
  EXPECT_EQ(comparison.grounds.front().mean_hidden.minCoeff(), 1);
  EXPECT_EQ(row.result.frames[7].markers_seen, 3);
  double hidden = 0;
  for (int k = 0; k < 20; ++k) {
    for (int i = 0; i < 4; ++i) {
      if (comparison.grounds.front().hidden(i, k)) hidden += row.distances(i, k) / 20;
    }
  }
  EXPECT_NEAR(row.quality.hidden.mean, hidden, kRounding);
}

TEST(Comparison, NumbersDoNotDependOnTheNumberOfJobs) {
  ComparisonOptions options;
  options.hiding = {HidingModel::kPaper, 0.1, 5};
  options.runs = 8;
  std::vector<std::vector<double>> means;
  for (const int jobs : {1, 2, 7}) {
    options.jobs = jobs;
    const Comparison comparison = CompareOn20Frames(
        {MakeContender("plain", "ABCD"), MakeContender("high", "ABCD", 100)}, options);
    std::vector<double> all;
    for (const ComparisonRow& row : comparison.rows) {
      ASSERT_EQ(row.failure, "");
      ASSERT_EQ(row.runs.size(), 8);
      for (const TrackingQuality& run : row.runs) all.push_back(run.all.mean);
      all.push_back(row.p95_distance[10]);
    }
    means.push_back(all);
  }
  EXPECT_EQ(means[0], means[1]);
  EXPECT_EQ(means[0], means[2]);
  EXPECT_NE(means[0][0], means[0][1]);  // another seed, other hidden markers
}

TEST(Comparison, BandsHoldTheRuns) {
  ComparisonOptions options;
  options.hiding = {HidingModel::kPaper, 0.1, 5};
  options.runs = 9;
  const Comparison comparison = CompareOn20Frames({MakeContender("plain", "ABCD")}, options);
  const ComparisonRow& row = comparison.rows.front();
  EXPECT_TRUE((row.p05_distance.array() <= row.mean_distance.array() + kRounding).all());
  EXPECT_TRUE((row.p95_distance.array() <= row.max_distance.array() + kRounding).all());
  EXPECT_GT(row.max_distance.maxCoeff(), row.mean_distance.maxCoeff());
  EXPECT_NEAR(row.max_distance.maxCoeff(), row.quality.all.worst_frame, kRounding);
}

TEST(Comparison, ReportsEveryRun) {
  ComparisonOptions options;
  options.runs = 3;
  options.jobs = 2;
  std::vector<int> done;
  Compare({MakeTrial(3)}, {MakeContender("a", "ABCD"), MakeContender("b", "ABCD")}, options,
          [&](int k, int all) {
            EXPECT_EQ(all, 6);
            done.push_back(k);
          });
  EXPECT_THAT(done, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(Comparison, FinishedResultsAreMeasuredTheSameWay) {
  const Comparison run = CompareOn20Frames({MakeContender("plain", "ABCD")});
  const ComparisonRow& row = run.rows.front();
  const Comparison finished = CompareFinished(MakeTrial(20), {MakeContender("plain", "ABCD")},
                                              {{row.setup.mapping, row.warnings, row.result}});
  EXPECT_EQ(finished.rows.front().quality.all.mean, row.quality.all.mean);
  EXPECT_EQ(finished.rows.front().quality.median_seconds, row.quality.median_seconds);
  EXPECT_EQ(finished.grounds.front().optimum, run.grounds.front().optimum);
  EXPECT_FALSE(finished.grounds.front().hidden.any());
}

TEST(Comparison, VerdictsOnALongRecordingAreThoseOfEveryFrame) {
  constexpr int kFrames = 5000;
  const KinematicModel model = testing::StickModel();
  PoseTrajectory motion;
  motion.rate = 100;
  for (int i = 0; i < model.num_joints(); ++i) motion.joint_names.push_back(model.joint(i).name);
  motion.postures.assign(kFrames, ZeroPosture(model));
  for (int k = 0; k < kFrames; ++k) {
    motion.postures[k].joint_angles.setConstant(0.5 * std::sin(0.02 * k));
  }
  Trial trial;
  trial.model = std::make_shared<KinematicModel>(model);
  trial.markers = SynthesizeMarkers(model, motion, {0.001, 0.0004, 0.25, 0.0001}, 1);
  Finished finished;
  for (int i = 0; i < 4; ++i) finished.mapping.assignments.push_back({LabelIx(i), MarkerIx(i)});
  // Far off up to frame 100, and in single frames between those that are fitted.
  for (int k = 0; k < kFrames; ++k) {
    const bool is_off = k < 100 || k % 1000 == 500 + 1;
    if (is_off) motion.postures[k].position.x() += 0.3;
  }
  finished.result.trajectory = motion;
  const Comparison comparison = CompareFinished(trial, {Contender{}}, {finished});
  const CommonGround& ground = comparison.grounds.front();
  EXPECT_EQ(ground.optimum_every, 3);
  EXPECT_EQ(comparison.rows.front().quality.first_good, 100);
  EXPECT_EQ(comparison.rows.front().quality.lost_frames, 105);
  const std::vector<int> joints = {0, 1};
  const Eigen::VectorXd exact =
      OptimalDistances(model, joints, ground.markers, ground.labels, trial.markers);
  for (int k = 0; k < kFrames; k += ground.optimum_every) {
    // Fits end where the cost changes by less than a millionth.
    EXPECT_NEAR(ground.optimum[k], exact[k], 0.01 * exact[k]) << k;
  }
}

}  // namespace
}  // namespace mmm_converter
