// SPDX-License-Identifier: MIT
#include "plugins/s2kf/reported_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "common/math/seeded_random.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/coverage.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/test_models.h"

namespace mmm_converter::s2kf {
namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

constexpr double kFrame = 0.01;  // [s]

/// A model in a posture, and what is said of it after frames in which its markers are measured.
class CovarianceScene {
 public:
  explicit CovarianceScene(const KinematicModel& model, const S2kfSettings& settings = {})
      : markers_(Setup(model)), covariance_(markers_, settings) {
    std::mt19937 random(3);
    posture_ = testing::RandomPosture(markers_.kinematics(), 0.4, &random);
    at_ = markers_.kinematics().MakeJacobian();
    markers_.kinematics().ComputeMarkers(posture_.position, posture_.orientation.toRotationMatrix(),
                                         posture_.joint_angles, &at_);
    offset_ = Matrix3Xd::Zero(3, markers_.kinematics().num_markers());
  }

  int num_markers() const { return markers_.kinematics().num_markers(); }
  int num_joints() const { return markers_.kinematics().num_joints(); }
  double HalfRange(int j) const {
    return 0.5 * (markers_.kinematics().upper()[j] - markers_.kinematics().lower()[j]);
  }

  /// Constant offsets from now on, `deviation` of each coordinate [m].
  void MoveMarkers(double deviation) { offset_ = Draw(deviation); }

  /// Measures with white noise; `hidden` are not seen.
  VectorXd Look(int frames, double noise, const std::set<int>& hidden = {}) {
    // An estimator that averages nothing.
    const VectorXd own = VectorXd::Constant(6 + num_joints(), 1e3);
    for (int k = 0; k < frames; ++k) {
      Matrix3Xd z = at_.p_WM + offset_ + Draw(noise);
      for (const int m : hidden) z.col(m).setConstant(NAN);
      covariance_.Look(z, at_, kFrame);
      if (covariance_.IsDue()) covariance_.Compute(posture_.joint_angles, own, &at_);
    }
    return covariance_.deviations();
  }

  const ReportedCovariance& covariance() const { return covariance_; }

 private:
  static TrackingSetup Setup(const KinematicModel& model) {
    std::vector<int> joints;
    for (int j = 0; j < model.num_joints(); ++j) joints.push_back(j);
    std::vector<MarkerAssignment> assignments;
    for (int m = 0; m < static_cast<int>(model.markers().size()); ++m) {
      assignments.push_back({LabelIx(m), MarkerIx(m), 1.0});
    }
    return SetupOf(model, joints, assignments);
  }

  Matrix3Xd Draw(double deviation) {
    Matrix3Xd drawn(3, num_markers());
    for (double& x : drawn.reshaped()) x = deviation * random_.Normal();
    return drawn;
  }

  TrackedMarkers markers_;
  ReportedCovariance covariance_;
  Posture posture_;
  MarkerJacobian at_;
  Matrix3Xd offset_;
  SeededRandom random_{1};
};

TEST(ReportedCovarianceTest, ResidualsTellOffsetsFromWhiteNoise) {
  const KinematicModel model = ScaledReferenceModel(1.8);
  CovarianceScene offsets(model);
  offsets.MoveMarkers(0.02);
  offsets.Look(200, 0.001);
  CovarianceScene noise(model);
  noise.Look(200, 0.02);
  EXPECT_GT(offsets.covariance().slow_variance(), 50 * offsets.covariance().white_variance());
  EXPECT_GT(noise.covariance().white_variance(), 5 * noise.covariance().slow_variance());
}

// Deviations are those of one look, however long it lasts.
TEST(ReportedCovarianceTest, TimeDoesNotMakeOffsetsBetterKnown) {
  CovarianceScene scene(ScaledReferenceModel(1.8));
  scene.MoveMarkers(0.02);
  const VectorXd early = scene.Look(20, 0.0005);
  const VectorXd late = scene.Look(500, 0.0005);
  for (Eigen::Index i = 0; i < early.size(); ++i) EXPECT_NEAR(late[i] / early[i], 1, 0.1) << i;
}

TEST(ReportedCovarianceTest, DeviationsGrowWithTheOffsets) {
  const auto deviations_with = [](double offset) {
    CovarianceScene scene(ScaledReferenceModel(1.8));
    scene.MoveMarkers(offset);
    return scene.Look(50, 0.0005);
  };
  // Joints that move no marker have the same in all.
  const VectorXd none = deviations_with(0);
  const VectorXd small = deviations_with(0.005);
  const VectorXd large = deviations_with(0.02);
  EXPECT_TRUE((small.array() >= none.array() * (1 - 1e-9)).all());
  EXPECT_TRUE((large.array() >= small.array() * (1 - 1e-9)).all());
  EXPECT_GT(large[0], 2.5 * small[0]);
  EXPECT_GT(small[0], 1.5 * none[0]);
}

TEST(ReportedCovarianceTest, AHiddenLimbIsLostWithTimeUpToItsRange) {
  CovarianceScene scene(testing::MakeBranchedModel());
  const VectorXd seen = scene.Look(50, 0.001);
  const std::set<int> hidden = {10, 11};  // all of the joint "d_x"
  const int joint = scene.num_joints() - 1;
  const VectorXd soon = scene.Look(20, 0.001, hidden);
  const VectorXd late = scene.Look(500, 0.001, hidden);
  const VectorXd back = scene.Look(20, 0.001);
  EXPECT_GT(soon[6 + joint], 2 * seen[6 + joint]);
  EXPECT_GT(late[6 + joint], 1.2 * soon[6 + joint]);
  EXPECT_GT(late[6 + joint], 0.3 * scene.HalfRange(joint));
  EXPECT_LT(late[6 + joint], 1.1 * scene.HalfRange(joint));
  EXPECT_LT(back[6 + joint], 0.5 * soon[6 + joint]);
}

TEST(ReportedCovarianceTest, UnseenJointsHaveTheDeviationOfTheirRange) {
  CovarianceScene scene(testing::MakeBranchedModel());
  const std::set<int> hidden = {10, 11};
  const VectorXd deviations = scene.Look(20, 0.001, hidden);
  const int joint = scene.num_joints() - 1;
  // Uniform: 0.58 from the middle, 1.15 from a limit; of the estimate, which is in between.
  EXPECT_GT(deviations[6 + joint], 0.35 * scene.HalfRange(joint));
  EXPECT_LT(deviations[6 + joint], 1.15 * scene.HalfRange(joint));
}

TEST(ReportedCovarianceTest, WhatTheSubjectLeavesUnknownCounts) {
  const auto deviations_with = [](double deviation) {
    const KinematicModel model = testing::MakeBranchedModel();
    ModelDescription known{model.name(), model.segments(), model.markers(), model.node_sets()};
    for (ModelMarker& marker : known.markers) marker.deviation = deviation;
    return CovarianceScene(KinematicModel(known)).Look(50, 0.001);
  };
  const VectorXd well = deviations_with(0.001);
  EXPECT_TRUE((deviations_with(0.02).array() > 1.2 * well.array()).all());
}

// With a hidden limb, so that angles are bounded by their range.
TEST(ReportedCovarianceTest, TheCovarianceHasTheDeviationsAndIsOne) {
  CovarianceScene scene(testing::MakeBranchedModel());
  scene.MoveMarkers(0.01);
  const VectorXd deviations = scene.Look(500, 0.001, {10, 11});
  const Eigen::MatrixXd P = scene.covariance().Covariance();
  ASSERT_EQ(P.rows(), deviations.size());
  EXPECT_EQ(P, P.transpose());
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    EXPECT_NEAR(P(i, i) / (deviations[i] * deviations[i]), 1, 1e-12) << i;
  }
  EXPECT_GT(P.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
}

// Both joints turn about the same axis, so that only their sum is well known.
TEST(ReportedCovarianceTest, AnglesThatReplaceEachOtherAreCorrelated) {
  const KinematicModel model = ScaledReferenceModel(1.8);
  CovarianceScene scene(model);
  scene.MoveMarkers(0.01);
  scene.Look(50, 0.001);
  const Eigen::MatrixXd P = scene.covariance().Covariance();
  const int lower = 6 + model.FindJoint("BPx_joint");
  const int upper = 6 + model.FindJoint("BTx_joint");
  EXPECT_LT(P(lower, upper) / std::sqrt(P(lower, lower) * P(upper, upper)), -0.3);
}

// The long form, over persons and motions, is in accuracy/deviations_test.cc.
TEST(ReportedCovarianceTest, CoversTheErrorsOfUnknownPersons) {
  Coverage coverage;
  for (const std::uint64_t seed : {201, 202, 203, 204}) {
    const Session session(seed);
    for (const NamedMotion& named : SessionMotions(session.model, 60, seed)) {
      const MarkerSequence seen = HideBlocks(session.Record(named.motion), seed);
      const PoseTrajectory estimate =
          S2kfConverter(SetupOf(session.model, session.joints, AssignAll(session.model, seen)), {})
              .Convert(seen, {})
              .trajectory;
      coverage.Add(session.model, session.joints, named.motion, estimate, 10, seen.num_frames());
    }
  }
  coverage.Print("uncalibrated");
  EXPECT_GE(coverage.Of("joints").One(), 0.55);
  EXPECT_LE(coverage.Of("joints").One(), 0.88);
  EXPECT_GE(coverage.Of("joints").Two(), 0.88);
}

}  // namespace
}  // namespace mmm_converter::s2kf
