// SPDX-License-Identifier: MIT
// The recursion of common/kinetics against Simbody's.
#include <gtest/gtest.h>

#include "common/dynamics/simbody_model.h"
#include "common/kinetics/inverse_dynamics.h"
#include "common/math/rotation.h"
#include "tests/common/dynamics/test_bodies.h"

namespace mmm_converter {
namespace {

TEST(NewtonEulerTest, IsSimbodysInverseDynamics) {
  const KinematicModel model = testing::Chain(6);
  const SimbodyModel simbody(model);
  SeededRandom random(11);
  const auto vector = [&random](Eigen::Index size) {
    Eigen::VectorXd v(size);
    for (double& x : v) x = random.Normal();
    return v;
  };
  for (int trial = 0; trial < 5; ++trial) {
    Posture posture = ZeroPosture(model);
    posture.position = vector(3);
    posture.orientation = Exp(Eigen::Vector3d(vector(3)));
    posture.joint_angles = vector(model.num_joints());
    const Eigen::VectorXd v = 2 * vector(6 + model.num_joints());
    const Eigen::VectorXd a = 5 * vector(6 + model.num_joints());
    const Eigen::VectorXd expected = simbody.Moving(posture, v, a).forces;
    const Eigen::VectorXd found = InverseDynamics(model, posture, v, a, {}, kGravity);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace mmm_converter
