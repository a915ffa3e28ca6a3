// SPDX-License-Identifier: MIT
#include "common/fit/posture_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/fit/posture_search.h"
#include "common/math/rotation.h"
#include "common/support/units.h"
#include "tests/support/test_models.h"

namespace mmm_converter {
namespace {

using testing::MakeBranchedModel;
using testing::MakeFullKinematics;
using testing::RandomPosture;

class PostureFitTest : public ::testing::Test {
 protected:
  Eigen::Matrix3Xd Markers(const Posture& q) {
    MarkerJacobian at = kinematics_.MakeJacobian();
    kinematics_.ComputeMarkers(q.position, q.orientation.toRotationMatrix(), q.joint_angles, &at);
    return at.p_WM;
  }

  KinematicModel model_ = MakeBranchedModel();
  MarkerKinematics kinematics_ = MakeFullKinematics(model_);
  Eigen::VectorXd scale_ = Eigen::VectorXd::Ones(kinematics_.num_markers());
  std::mt19937 random_{1};
};

TEST_F(PostureFitTest, FindsTheExactPostureAgain) {
  PostureFit fit(kinematics_);
  PostureFitOptions options;
  options.natural_weight = 0;
  options.tolerance = 1e-12;
  options.max_iterations = 100;
  for (int i = 0; i < 20; ++i) {
    const Posture truth = RandomPosture(kinematics_, 0.9, &random_);
    Posture q = Retract(truth, 0.1 * Eigen::VectorXd::Random(kinematics_.num_dofs()));
    const PostureFit::Result result = fit.Solve(Markers(truth), scale_, options, &q);
    EXPECT_TRUE(result.converged);
    // Quadratic convergence until the cost no longer falls in double precision.
    EXPECT_LT(Local(truth, q).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST_F(PostureFitTest, APostureThatIsNotFiniteIsForgotten) {
  const Posture truth = RandomPosture(kinematics_, 0.5, &random_);
  const Posture start = Retract(truth, 0.1 * Eigen::VectorXd::Ones(kinematics_.num_dofs()));
  Posture broken = start;
  broken.position.x() = kNaN;
  PostureFit fit(kinematics_);
  fit.Solve(Markers(truth), scale_, {}, &broken);
  Posture after = start;
  fit.Solve(Markers(truth), scale_, {}, &after);
  Posture fresh = start;
  PostureFit(kinematics_).Solve(Markers(truth), scale_, {}, &fresh);
  EXPECT_EQ(after.position, fresh.position);
  EXPECT_EQ(after.joint_angles, fresh.joint_angles);
}

TEST_F(PostureFitTest, MissingMarkersAreLeftOut) {
  PostureFit fit(kinematics_);
  PostureFitOptions options;
  options.natural_weight = 1e-6;
  options.tolerance = 1e-10;
  const Posture truth = RandomPosture(kinematics_, 0.5, &random_);
  Eigen::Matrix3Xd z = Markers(truth);
  for (const int hidden : {0, 4, 6}) z.col(hidden).setConstant(kNaN);
  Posture q = Retract(truth, 0.05 * Eigen::VectorXd::Ones(kinematics_.num_dofs()));
  const PostureFit::Result result = fit.Solve(z, scale_, options, &q);
  EXPECT_TRUE(std::isfinite(result.cost));
  EXPECT_LT((Markers(q) - Markers(truth)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST_F(PostureFitTest, StaysInsideLimitsWhereTheTruthIsOutside) {
  PostureFit fit(kinematics_);
  Posture beyond = RandomPosture(kinematics_, 0.5, &random_);
  beyond.joint_angles = kinematics_.upper().array() + 0.3;
  Posture q = RandomPosture(kinematics_, 0.5, &random_);
  q.position = beyond.position;
  q.orientation = beyond.orientation;
  fit.Solve(Markers(beyond), scale_, {}, &q);
  EXPECT_TRUE((q.joint_angles.array() <= kinematics_.upper().array()).all());
  EXPECT_TRUE((q.joint_angles.array() >= kinematics_.lower().array()).all());
  EXPECT_GT((q.joint_angles.array() == kinematics_.upper().array()).count(), 0);
}

TEST_F(PostureFitTest, NothingInReachLowersTheCostOfAConvergedFit) {
  PostureFit fit(kinematics_);
  PostureFitOptions options;
  options.tolerance = 1e-12;
  options.max_iterations = 200;
  std::normal_distribution<double> normal(0, 0.02);
  Posture q = RandomPosture(kinematics_, 0.5, &random_);
  Eigen::Matrix3Xd z = Markers(q);
  for (double& value : z.reshaped()) value += normal(random_);
  const double cost = fit.Solve(z, scale_, options, &q).cost;
  for (int i = 0; i < 500; ++i) {
    Posture other =
        Retract(q, 0.1 * normal(random_) * Eigen::VectorXd::Random(kinematics_.num_dofs()));
    other.joint_angles =
        other.joint_angles.cwiseMax(kinematics_.lower()).cwiseMin(kinematics_.upper());
    EXPECT_GE(fit.Evaluate(z, scale_, options, other).cost, cost * (1 - 1e-9));
  }
}

TEST_F(PostureFitTest, HuberBoundsTheHarmOfOneWildMarker) {
  const Posture truth = RandomPosture(kinematics_, 0.5, &random_);
  Eigen::Matrix3Xd z = Markers(truth);
  z.col(5) += Eigen::Vector3d(0.6, -0.4, 0.3);
  PostureFit fit(kinematics_);
  PostureFitOptions robust;
  robust.robust_distance = 0.01;
  Posture plain_posture = truth;
  Posture robust_posture = truth;
  fit.Solve(z, scale_, {}, &plain_posture);
  fit.Solve(z, scale_, robust, &robust_posture);
  EXPECT_LT(Local(truth, robust_posture).norm(), 0.3 * Local(truth, plain_posture).norm());
}

TEST_F(PostureFitTest, WhatNoMarkerDeterminesStaysNatural) {
  // The markers of the last two joints are gone: their angles are free, and rest at 0.
  PostureFit fit(kinematics_);
  const Posture truth = RandomPosture(kinematics_, 0.9, &random_);
  Eigen::Matrix3Xd z = Markers(truth);
  for (const int hidden : {8, 9, 10, 11}) z.col(hidden).setConstant(kNaN);
  Posture q = truth;
  PostureFitOptions options;
  options.tolerance = 1e-10;
  fit.Solve(z, scale_, options, &q);
  for (const char* name : {"c_oblique", "d_x"}) {
    EXPECT_NEAR(q.joint_angles[model_.FindJoint(name)], 0, 1e-4) << name;
  }
}

TEST_F(PostureFitTest, SearchStartsFromNothing) {
  PostureSearch search(kinematics_);
  std::normal_distribution<double> normal(0, 0.001);
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    const Posture truth = RandomPosture(kinematics_, 0.6, &random_);
    Eigen::Matrix3Xd z = Markers(truth);
    for (double& value : z.reshaped()) value += normal(random_);
    Posture q;
    found += search.Assemble(z, scale_, {}, 8, &q).mean_distance < 0.003;
  }
  EXPECT_GE(found, 48);
}

TEST_F(PostureFitTest, SearchIsReproducible) {
  const Posture truth = RandomPosture(kinematics_, 0.9, &random_);
  const Eigen::Matrix3Xd z = Markers(truth);
  Posture first;
  Posture second;
  PostureSearch(kinematics_).Assemble(z, scale_, {}, 4, &first);
  PostureSearch(kinematics_).Assemble(z, scale_, {}, 4, &second);
  EXPECT_EQ(first.position, second.position);
  EXPECT_EQ(first.joint_angles, second.joint_angles);
}

}  // namespace
}  // namespace mmm_converter
