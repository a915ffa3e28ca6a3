// SPDX-License-Identifier: MIT
#include "plugins/jacobian/jacobian_converter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/evaluate/optimal_fit.h"
#include "common/evaluate/tracking_quality.h"
#include "common/math/statistics.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_residuals.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/occlusion.h"
#include "common/motion/synthetic_motion.h"
#include "common/support/error.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/tracking_run.h"

namespace mmm_converter::jacobian {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class JacobianConverterTest : public ::testing::Test {
 protected:
  JacobianConverterTest() : motion_(MakeHandstand(model_)) {}

  MarkerSequence MakeMarkers(const MarkerErrors& errors) const {
    return SynthesizeMarkers(model_, motion_, errors, 1);
  }

  ConversionResult Convert(const MarkerSequence& markers, const JacobianSettings& settings) const {
    const auto assignments = s2kf::AssignByName(model_, markers);
    JacobianConverter converter(model_, assignments, joints_, settings);
    return converter.Convert(markers, model_, assignments, nullptr);
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

  double LargestStep(const ConversionResult& result, int joint) const {
    double largest = 0;
    for (int k = 1; k < result.trajectory.num_frames(); ++k) {
      largest = std::max(largest, std::abs(result.trajectory.postures[k].joint_angles[joint] -
                                           result.trajectory.postures[k - 1].joint_angles[joint]));
    }
    return largest;
  }

  const KinematicModel model_ = s2kf::PersonModel(1.8);
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
  const auto assignments = s2kf::AssignByName(model_, markers);
  s2kf::S2kfConverter converter(model_, assignments, joints_, {});
  const ConversionResult filter = converter.Convert(markers, model_, assignments, nullptr);
  std::vector<int> indices(markers.num_labels());
  for (int i = 0; i < markers.num_labels(); ++i) indices[i] = assignments[i].marker;
  std::vector<int> labels(markers.num_labels());
  for (int i = 0; i < markers.num_labels(); ++i) labels[i] = assignments[i].label;
  const VectorXd optimum = OptimalDistances(model_, joints_, indices, labels, markers);
  // In squares nothing is below the optimum; in mean distances by the tolerance of the fits.
  EXPECT_NEAR(MeanDistance(fit), optimum.mean(), 1e-5);
  EXPECT_LE(MeanDistance(fit), MeanDistance(filter));
  const double squares = fit.residuals.squaredNorm();
  EXPECT_LE(squares, filter.residuals.squaredNorm());
}

TEST_F(JacobianConverterTest, TheGradientLagsBehindFastJointsOnlyForItsBudget) {
  const MarkerSequence markers = MakeMarkers({});
  const double optimum = MeanDistance(Convert(markers, {}));
  const double two = MeanDistance(Convert(markers, Gradient(2)));
  const double three = MeanDistance(Convert(markers, Gradient(3)));
  const double ten = MeanDistance(Convert(markers, Gradient(10)));
  JacobianSettings unlimited = Gradient(1);
  unlimited.step_limit = 10;
  const double one_free = MeanDistance(Convert(markers, unlimited));
  // Two steps of 0.02 rad are slower than the fastest joint of the motion, ten are not.
  double fastest = 0;
  for (int k = 1; k < motion_.num_frames(); ++k) {
    fastest =
        std::max(fastest, (motion_.postures[k].joint_angles - motion_.postures[k - 1].joint_angles)
                              .cwiseAbs()
                              .maxCoeff());
  }
  EXPECT_GT(fastest, 2 * 0.02);
  EXPECT_LT(fastest, 10 * 0.02);
  EXPECT_GT(two, 1.3 * optimum);
  EXPECT_LT(three, two);
  EXPECT_LT(ten, 1.05 * optimum);
  EXPECT_LT(one_free, 1.05 * optimum);
}

TEST_F(JacobianConverterTest, LimitsHoldWithMarkersMissing) {
  const MarkerSequence markers = OccludeAtRandom(MakeMarkers({}).Slice(0, 300), {}, 1);
  for (const JacobianSettings& settings : {JacobianSettings(), Gradient(2)}) {
    const ConversionResult result = Convert(markers, settings);
    for (const Posture& posture : result.trajectory.postures) {
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        EXPECT_GE(posture.joint_angles[j], model_.joint(joints_[j]).lower);
        EXPECT_LE(posture.joint_angles[j], model_.joint(joints_[j]).upper);
      }
    }
  }
}

TEST_F(JacobianConverterTest, WithoutMarkersThePostureStays) {
  const MarkerSequence markers = HideAllMarkers(MakeMarkers({}).Slice(0, 60), 20, 40);
  for (const JacobianSettings& settings : {JacobianSettings(), Gradient(2)}) {
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
  markers = HideMarkers(markers, {"LWTS", "RKNE"}, 10, 40);
  const ConversionResult result = Convert(markers, {});
  EXPECT_LT(SummarizeResiduals(result.residuals).max, 1e-3);
  EXPECT_EQ(result.frames[20].markers_seen, 51);
}

TEST_F(JacobianConverterTest, ThePullKeepsJointsThatLostTheirMarkersFromJumping) {
  const MarkerSequence markers = OccludeAtRandom(MakeMarkers({}), {0.005, 100}, 2);
  JacobianSettings pull;
  pull.previous_weight = 0.2;
  const ConversionResult free = Convert(markers, {});
  const ConversionResult held = Convert(markers, pull);
  double free_step = 0;
  double held_step = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    free_step = std::max(free_step, LargestStep(free, static_cast<int>(j)));
    held_step = std::max(held_step, LargestStep(held, static_cast<int>(j)));
  }
  EXPECT_LT(held_step, 0.5 * free_step);
}

TEST_F(JacobianConverterTest, KnowsNoUncertainty) {
  const ConversionResult result = Convert(MakeMarkers({}).Slice(0, 3), {});
  EXPECT_TRUE(result.trajectory.standard_deviations.array().isNaN().all());
}

TEST_F(JacobianConverterTest, TwoMarkersAreTooFewToStart) {
  MarkerSequence markers = MakeMarkers({}).Slice(0, 1);
  markers.frame(0).rightCols(markers.num_labels() - 2).setConstant(std::nan(""));
  JacobianConverter converter(model_, s2kf::AssignByName(model_, markers), joints_, {});
  EXPECT_THROW(converter.Assemble(markers.frame(0)), Error);
}

}  // namespace
}  // namespace mmm_converter::jacobian
