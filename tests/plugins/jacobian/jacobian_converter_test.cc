// SPDX-License-Identifier: MIT
#include "plugins/jacobian/jacobian_converter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_residuals.h"
#include "common/motion/marker_synthesis.h"
#include "common/study/optimal_fit.h"
#include "common/study/tracking_quality.h"
#include "common/support/error.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/acrobatics.h"
#include "tests/support/changed_markers.h"

namespace mmm_converter::jacobian {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class JacobianConverterTest : public ::testing::Test {
 protected:
  JacobianConverterTest() : motion_(testing::MakeKickedHandstand(model_)) {}

  MarkerSequence MakeMarkers(const MarkerErrors& errors) const {
    return SynthesizeMarkers(model_, motion_, errors, 1);
  }

  ConversionResult Convert(const MarkerSequence& markers, const JacobianSettings& settings) const {
    const auto assignments = s2kf::AssignAll(model_, markers);
    JacobianConverter converter(s2kf::SetupOf(model_, joints_, assignments), settings);
    return converter.Convert(markers, nullptr);
  }

  static JacobianSettings Gradient(int steps) {
    JacobianSettings settings;
    settings.method = Method::kGradient;
    settings.steps = steps;
    return settings;
  }

  static double MeanDistance(const ConversionResult& result) {
    return SummarizeResiduals(result.residuals).mean;
  }

  // As in jacobian_pull.xml.
  static JacobianSettings Pull() {
    JacobianSettings settings;
    settings.previous_weight = 0.2;
    return settings;
  }

  // Of the fastest joint [rad].
  static double StepOfFrame(const PoseTrajectory& motion, int k) {
    return (motion.postures[k].joint_angles - motion.postures[k - 1].joint_angles)
        .cwiseAbs()
        .maxCoeff();
  }

  static double LargestStep(const PoseTrajectory& motion) {
    double largest = 0;
    for (int k = 1; k < motion.num_frames(); ++k) {
      largest = std::max(largest, StepOfFrame(motion, k));
    }
    return largest;
  }

  static double Median(VectorXd values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
  }

  // A posture between each two.
  static PoseTrajectory AtHalfTheSpeed(const PoseTrajectory& motion) {
    PoseTrajectory slow = motion;
    slow.postures.clear();
    for (int k = 0; k + 1 < motion.num_frames(); ++k) {
      const Posture& a = motion.postures[k];
      slow.postures.push_back(a);
      slow.postures.push_back(Retract(a, 0.5 * Local(a, motion.postures[k + 1])));
    }
    return slow;
  }

  const KinematicModel model_ = s2kf::ScaledReferenceModel(1.8);
  const std::vector<int> joints_ = s2kf::MotionJoints(model_, 44);
  PoseTrajectory motion_;
};

constexpr MarkerErrors kExact = {0, 0, 0.25, 0};

TEST_F(JacobianConverterTest, MarkersWithoutErrorAreMetExactly) {
  const ConversionResult result = Convert(MakeMarkers(kExact), {});
  // The weak pull to the natural posture is all that is left.
  EXPECT_LT(SummarizeResiduals(result.residuals).max, 5e-4);
  for (const FrameDiagnostic& frame : result.frames) EXPECT_TRUE(frame.converged);
}

TEST_F(JacobianConverterTest, LeastSquaresIsTheOptimumAndTheFilterIsNotBelow) {
  const MarkerSequence markers = MakeMarkers({});
  const ConversionResult fit = Convert(markers, {});
  const auto assignments = s2kf::AssignAll(model_, markers);
  s2kf::S2kfConverter converter(s2kf::SetupOf(model_, joints_, assignments), {});
  const ConversionResult filter = converter.Convert(markers, nullptr);
  const VectorXd optimum = OptimalDistances(model_, joints_, MarkerIndices(assignments),
                                            LabelIndices(assignments), markers);
  // In squares nothing is below the optimum; in mean distances by the tolerance of the fits.
  EXPECT_NEAR(MeanDistance(fit), optimum.mean(), 1e-5);
  EXPECT_LE(MeanDistance(fit), MeanDistance(filter));
  const VectorXd fit_squares = fit.residuals.colwise().squaredNorm();
  const VectorXd filter_squares = filter.residuals.colwise().squaredNorm();
  // In each frame, too, up to what the pull to the natural posture and the tolerance leave.
  EXPECT_LT((fit_squares.array() / filter_squares.array()).maxCoeff(), 1.001);
  EXPECT_LT((MeanOfEachFrame(fit.residuals) - optimum).cwiseAbs().maxCoeff(), 1e-4);
}

TEST_F(JacobianConverterTest, TheGradientLagsBehindFastJointsOnlyForItsBudget) {
  const MarkerSequence markers = MakeMarkers({});
  const VectorXd optimum = MeanOfEachFrame(Convert(markers, {}).residuals);
  const auto frames = [&](const JacobianSettings& settings) {
    return MeanOfEachFrame(Convert(markers, settings).residuals);
  };
  const VectorXd two = frames(Gradient(2));
  const VectorXd three = frames(Gradient(3));
  JacobianSettings unlimited = Gradient(1);
  unlimited.step_limit = 10;
  const VectorXd one_free = frames(unlimited);
  int fast_frames = 0;
  double fast_distance = 0;
  for (int k = 1; k < motion_.num_frames(); ++k) {
    if (StepOfFrame(motion_, k) <= 2 * 0.02) continue;
    ++fast_frames;
    fast_distance += two[k];
  }
  ASSERT_GT(fast_frames, 0);
  fast_distance /= fast_frames;
  const double slow_distance =
      (two.sum() - fast_distance * fast_frames) / static_cast<double>(two.size() - fast_frames);
  std::printf(
      "[ measured ] fastest joint %.3f rad a frame; %d frames beyond 0.04: %.1f mm there, "
      "%.1f elsewhere\n",
      LargestStep(motion_), fast_frames, 1e3 * fast_distance, 1e3 * slow_distance);
  // Two steps of 0.02 rad are slower than the fastest joint of the motion, three are not.
  EXPECT_GT(LargestStep(motion_), 2 * 0.02);
  EXPECT_LT(LargestStep(motion_), 3 * 0.02);
  EXPECT_GT(two.maxCoeff(), 1.5 * optimum.maxCoeff());
  EXPECT_LT(three.maxCoeff(), 1.01 * optimum.maxCoeff());
  EXPECT_LT(one_free.maxCoeff(), 1.01 * optimum.maxCoeff());
  // It lags where joints are fast and catches up behind them: elsewhere it has the optimum.
  EXPECT_LT(slow_distance, 1.05 * optimum.mean());
  EXPECT_GT(fast_distance, 1.2 * optimum.mean());
  EXPECT_LT(Median(two), 1.01 * Median(optimum));
}

// That the speed of the joints is the cause: the same motion at half the speed, the same budget.
TEST_F(JacobianConverterTest, AtHalfTheSpeedTheGradientHasTheOptimum) {
  motion_ = AtHalfTheSpeed(motion_);
  EXPECT_LT(LargestStep(motion_), 2 * 0.02);
  const MarkerSequence markers = MakeMarkers({});
  const VectorXd optimum = MeanOfEachFrame(Convert(markers, {}).residuals);
  const ConversionResult gradient = Convert(markers, Gradient(2));
  std::printf(
      "[ measured ] half the speed: gradient %.2f mm, worst frame %.1f; optimum %.2f, %.1f\n",
      1e3 * MeanDistance(gradient), 1e3 * MeanOfEachFrame(gradient.residuals).maxCoeff(),
      1e3 * optimum.mean(), 1e3 * optimum.maxCoeff());
  EXPECT_LT(MeanOfEachFrame(gradient.residuals).maxCoeff(), 1.01 * optimum.maxCoeff());
  EXPECT_LT(MeanDistance(gradient), 1.001 * optimum.mean());
}

TEST_F(JacobianConverterTest, LimitsHoldWithAThirdOfTheMarkersMissing) {
  const MarkerSequence markers = testing::OccludeShare(MakeMarkers({}).Slice(0, 300), 0.33, 100, 1);
  for (const JacobianSettings& settings : {JacobianSettings(), Pull(), Gradient(2)}) {
    const ConversionResult result = Convert(markers, settings);
    ASSERT_EQ(result.trajectory.num_frames(), 300);
    EXPECT_EQ(result.frames[150].markers_seen, 36);  // 53 - round(0.33 * 53)
    for (const Posture& posture : result.trajectory.postures) {
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        EXPECT_GE(posture.joint_angles[j], model_.joint(joints_[j]).lower);
        EXPECT_LE(posture.joint_angles[j], model_.joint(joints_[j]).upper);
      }
    }
  }
}

// Any number of markers, down to none, gives a posture inside the limits and no exception.
TEST_F(JacobianConverterTest, FewMarkersAreNoErrorOnceItRuns) {
  const MarkerSequence all = MakeMarkers({}).Slice(0, 60);
  for (const int seen : {1, 2, 3}) {
    MarkerSequence markers = all;
    for (int k = 20; k < 40; ++k) {
      markers.frame(k).rightCols(markers.num_labels() - seen).setConstant(std::nan(""));
    }
    for (const JacobianSettings& settings : {JacobianSettings(), Pull(), Gradient(2)}) {
      const ConversionResult result = Convert(markers, settings);
      EXPECT_EQ(result.frames[30].markers_seen, seen);
      EXPECT_EQ(result.frames[30].converged && seen < 3, false);
      for (const Posture& posture : result.trajectory.postures) {
        EXPECT_TRUE(posture.position.allFinite());
        EXPECT_TRUE(posture.joint_angles.allFinite());
      }
    }
  }
}

TEST_F(JacobianConverterTest, WithoutMarkersThePostureStays) {
  const MarkerSequence markers = testing::HideAllMarkers(MakeMarkers({}).Slice(0, 60), 20, 40);
  for (const JacobianSettings& settings : {JacobianSettings(), Pull(), Gradient(2)}) {
    const ConversionResult result = Convert(markers, settings);
    const Posture& before = result.trajectory.postures[19];
    const Posture& after = result.trajectory.postures[39];
    EXPECT_EQ(before.joint_angles, after.joint_angles);
    EXPECT_EQ(before.position, after.position);
    EXPECT_EQ(result.frames[30].markers_seen, 0);
    EXPECT_FALSE(result.frames[30].converged);
    EXPECT_TRUE(std::isnan(result.residuals(0, 30)));
  }
}

TEST_F(JacobianConverterTest, AHiddenMarkerIsLeftOut) {
  MarkerSequence markers = MakeMarkers(kExact).Slice(0, 40);
  markers = testing::HideMarkers(markers, {"LWTS", "RKNE"}, 10, 40);
  const ConversionResult result = Convert(markers, {});
  EXPECT_LT(SummarizeResiduals(result.residuals).max, 1e-3);
  EXPECT_EQ(result.frames[20].markers_seen, 51);
}

TEST_F(JacobianConverterTest, ThePullKeepsJointsThatLostTheirMarkersFromJumping) {
  const MarkerSequence markers = testing::OccludeAtRandom(MakeMarkers({}), {0.005, 100}, 2);
  const ConversionResult free = Convert(markers, {});
  const ConversionResult held = Convert(markers, Pull());
  EXPECT_LT(LargestStep(held.trajectory), 0.5 * LargestStep(free.trajectory));
}

TEST_F(JacobianConverterTest, KnowsNoUncertainty) {
  const ConversionResult result = Convert(MakeMarkers({}).Slice(0, 3), {});
  EXPECT_TRUE(result.trajectory.standard_deviations.array().isNaN().all());
}

TEST_F(JacobianConverterTest, TwoMarkersAreTooFewToStart) {
  MarkerSequence markers = MakeMarkers({}).Slice(0, 1);
  markers.frame(0).rightCols(markers.num_labels() - 2).setConstant(std::nan(""));
  JacobianConverter converter(s2kf::SetupOf(model_, joints_, s2kf::AssignAll(model_, markers)), {});
  EXPECT_THROW(converter.Assemble(markers.frame(0)), Error);
}

}  // namespace
}  // namespace mmm_converter::jacobian
