// SPDX-License-Identifier: MIT
#include "common/motion/marker_synthesis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/model/forward_kinematics.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

/// A root with many markers at the same place and an arm that turns about z.
KinematicModel ManyMarkers(int count) {
  ModelDescription description;
  description.name = "many";
  Segment root;
  root.name = "root";
  Segment arm;
  arm.name = "arm";
  arm.parent = 0;
  arm.type = JointType::kRevolute;
  arm.lower = -3;
  arm.upper = 3;
  description.segments = {root, arm};
  for (int i = 0; i < count; ++i) {
    description.markers.push_back(
        {std::string("MARKER_M").append(std::to_string(i)), i % 2, {0.1, 0.2, 0.3}});
  }
  return KinematicModel(description);
}

PoseTrajectory Turning(int num_frames) {
  PoseTrajectory motion;
  motion.rate = 100;
  motion.first_time = 2;
  motion.joint_names = {"arm"};
  for (int k = 0; k < num_frames; ++k) {
    Posture posture;
    posture.position = {0.01 * k, 0, 1};
    posture.orientation = Eigen::AngleAxisd(0.02 * k, Eigen::Vector3d::UnitX());
    posture.joint_angles = Eigen::VectorXd::Constant(1, 0.03 * k);
    motion.postures.push_back(posture);
  }
  return motion;
}

/// What was added to marker i in frame k, in its segment's frame.
Eigen::Vector3d LocalError(const KinematicModel& model, const PoseTrajectory& motion,
                           const MarkerSequence& sequence, int k, int i) {
  const auto X_WS = SegmentPoses(model, ModelPosture(model, motion, k));
  const ModelMarker& marker = model.markers()[i];
  return X_WS[marker.segment].inverse() * sequence.frame(k).col(i) - marker.p_SM;
}

TEST(MarkerSynthesisTest, WithoutErrorsIsForwardKinematics) {
  const KinematicModel model = ManyMarkers(4);
  const PoseTrajectory motion = Turning(30);
  const MarkerSequence sequence = SynthesizeMarkers(model, motion, {0, 0, 0.25, 0}, 1);
  EXPECT_EQ(sequence.labels(), (std::vector<std::string>{"M0", "M1", "M2", "M3"}));
  EXPECT_EQ(sequence.rate(), 100);
  EXPECT_EQ(sequence.first_time(), 2);
  for (int k = 0; k < 30; ++k) {
    const auto expected = MarkerPositions(model, ModelPosture(model, motion, k));
    // The same products in another order.
    EXPECT_LT((sequence.frame(k) - expected).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(MarkerSynthesisTest, OffsetsAreConstantInTheSegment) {
  const KinematicModel model = ManyMarkers(400);
  const PoseTrajectory motion = Turning(20);
  const MarkerSequence sequence = SynthesizeMarkers(model, motion, {0.028, 0, 0.25, 0}, 1);
  double squares = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d first = LocalError(model, motion, sequence, 0, i);
    EXPECT_LT((LocalError(model, motion, sequence, 19, i) - first).norm(), 1e-14);
    squares += first.squaredNorm();
  }
  // 1200 normals: the deviation's relative error is 1 / sqrt(2400) = 0.02; three of them.
  EXPECT_NEAR(std::sqrt(squares / 1200), 0.028, 0.06 * 0.028);
}

TEST(MarkerSynthesisTest, WobbleIsStationaryAndForgetsWithItsTimeConstant) {
  const KinematicModel model = ManyMarkers(400);
  const PoseTrajectory motion = Turning(200);
  const MarkerSequence sequence = SynthesizeMarkers(model, motion, {0, 0.004, 0.25, 0}, 1);
  for (const int k : {0, 174}) {
    double variance = 0;
    double covariance = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d now = LocalError(model, motion, sequence, k, i);
      variance += now.squaredNorm() / 1200;
      covariance += now.dot(LocalError(model, motion, sequence, k + 25, i)) / 1200;
    }
    EXPECT_NEAR(std::sqrt(variance), 0.004, 0.06 * 0.004);
    // Correlation after 25 frames = 0.25 s is 1/e; its error is 1 / sqrt(1200) = 0.03.
    EXPECT_NEAR(covariance / variance, 1 / std::numbers::e, 0.09);
  }
}

TEST(MarkerSynthesisTest, NoiseIsWhite) {
  const KinematicModel model = ManyMarkers(400);
  const PoseTrajectory motion = Turning(2);
  const MarkerSequence sequence = SynthesizeMarkers(model, motion, {0, 0, 0.25, 0.001}, 1);
  double variance = 0;
  double covariance = 0;
  for (int i = 0; i < 400; ++i) {
    const auto error = [&](int k) -> Eigen::Vector3d {
      return (sequence.frame(k) - MarkerPositions(model, ModelPosture(model, motion, k))).col(i);
    };
    variance += error(0).squaredNorm() / 1200;
    covariance += error(0).dot(error(1)) / 1200;
  }
  EXPECT_NEAR(std::sqrt(variance), 0.001, 0.06 * 0.001);
  EXPECT_NEAR(covariance / variance, 0, 0.09);
}

TEST(MarkerSynthesisTest, SeedDecidesAndErrorsAreIndependentOfTheMotion) {
  const KinematicModel model = ManyMarkers(4);
  const PoseTrajectory motion = Turning(10);
  const MarkerSequence a = SynthesizeMarkers(model, motion, {}, 7);
  EXPECT_EQ(a.frame(9), SynthesizeMarkers(model, motion, {}, 7).frame(9));
  EXPECT_NE(a.frame(9), SynthesizeMarkers(model, motion, {}, 8).frame(9));
  EXPECT_EQ(a.frame(9), SynthesizeMarkers(model, Turning(20), {}, 7).frame(9));
}

TEST(MarkerSynthesisTest, UnknownJointIsNamed) {
  PoseTrajectory motion = Turning(1);
  motion.joint_names = {"tail"};
  try {
    SynthesizeMarkers(ManyMarkers(1), motion, {}, 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'tail'"), std::string::npos);
  }
}

}  // namespace
}  // namespace mmm_converter
