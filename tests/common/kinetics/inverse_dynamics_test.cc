// SPDX-License-Identifier: MIT
#include "common/kinetics/inverse_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/spline_derivatives.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kG = kStandardGravity;
constexpr double kExact = 1e-12;

Segment Link(const std::string& name, int parent, JointType type, const Vector3d& axis) {
  Segment link;
  link.name = name;
  link.parent = parent;
  link.type = type;
  link.axis = axis;
  link.lower = -10;
  link.upper = 10;
  return link;
}

ModelDescription OnGround() {
  ModelDescription description;
  description.name = "mechanism";
  description.is_root_fixed = true;
  description.segments.resize(1);
  description.segments[0].name = "ground";
  return description;
}

VectorXd Vector(int joints, double value) {
  VectorXd all = VectorXd::Zero(6 + joints);
  all.tail(joints).setConstant(value);
  return all;
}

TEST(InverseDynamicsTest, APendulum) {
  ModelDescription description = OnGround();
  Segment rod = Link("rod", 0, JointType::kRevolute, Vector3d::UnitY());
  rod.mass = 2;
  rod.p_SB = {0, 0, -0.4};
  rod.inertia = Vector3d(0.1, 0.2, 0.3).asDiagonal();
  description.segments.push_back(rod);
  const KinematicModel model(description);
  Posture posture = ZeroPosture(model);
  posture.joint_angles[0] = 0.7;
  const VectorXd forces = InverseDynamics(model, posture, Vector(1, 1.5), Vector(1, -3), {});
  EXPECT_NEAR(forces[6], (0.2 + 2 * 0.16) * -3 + 2 * kG * 0.4 * std::sin(0.7), kExact);
  // The ground holds the weight and what turns the rod about its end.
  const double radial = 2 * 0.4 * 1.5 * 1.5;
  const double tangential = 2 * 0.4 * -3;
  EXPECT_NEAR(forces[2], 2 * kG + radial * std::cos(0.7) + tangential * std::sin(0.7), kExact);
}

TEST(InverseDynamicsTest, AHingeHoldsAboutItsOtherAxes) {
  ModelDescription description = OnGround();
  description.segments.push_back(Link("rod", 0, JointType::kRevolute, Vector3d::UnitY()));
  description.segments.back().X_PF.translation() << 1, 2, 3;
  const KinematicModel model(description);
  const Vector3d force(4, 5, -6), p_W(1.5, 2.5, 2);
  std::vector<Vector3d> carried;
  InverseDynamics(model, ZeroPosture(model), Vector(1, 0), Vector(1, 0),
                  {{1, force, p_W.cross(force)}}, kG, &carried);
  ASSERT_EQ(carried.size(), 2);
  EXPECT_NEAR((carried[1] + (p_W - Vector3d(1, 2, 3)).cross(force)).norm(), 0, kExact);
}

TEST(InverseDynamicsTest, AMassThatAFunctionLifts) {
  ModelDescription description = OnGround();
  Segment mass = Link("mass", 0, JointType::kSliding, Vector3d::UnitZ());
  mass.mass = 3;
  mass.function = std::make_shared<ScalarFunction>(  // q^2 / 2 + q, then 2 of that
      ScalarFunction::Linear(2, 0).After(ScalarFunction::Polynomial({0.5, 1, 0})));
  description.segments.push_back(mass);
  const KinematicModel model(description);
  Posture posture = ZeroPosture(model);
  posture.joint_angles[0] = 0.5;
  const VectorXd forces = InverseDynamics(model, posture, Vector(1, 0.8), Vector(1, 2), {});
  const double slope = 3;  // 2 (q + 1); its own slope is 2
  EXPECT_NEAR(forces[6], 3 * slope * (slope * 2 + 2 * 0.8 * 0.8 + kG), kExact);
}

/// A knee that turns about two axes and shifts by one coordinate, and a joint on it.
KinematicModel Knee() {
  ModelDescription description = OnGround();
  Segment bend = Link("bend", 0, JointType::kRevolute, Vector3d(0.1, 1, 0.2).normalized());
  bend.X_PF.translation() = Vector3d(0.1, 0, 1);
  Segment twist = Link("twist", 1, JointType::kRevolute, Vector3d(0.5, 0.1, 1).normalized());
  twist.leader = 1;
  twist.function = std::make_shared<ScalarFunction>(
      ScalarFunction::SimmSpline({-2, -1, 0, 1, 2}, {0.3, 0.2, 0, -0.4, 0.1}));
  Segment shift = Link("shift", 2, JointType::kSliding, Vector3d::UnitX());
  shift.leader = 1;
  shift.function = std::make_shared<ScalarFunction>(ScalarFunction::Polynomial({0.05, 0, 0.01, 0}));
  shift.mass = 4;
  shift.p_SB = {0.02, -0.03, -0.2};
  shift.inertia << 0.05, 0.01, 0, 0.01, 0.06, 0.005, 0, 0.005, 0.02;
  Segment ankle = Link("ankle", 3, JointType::kRevolute, Vector3d(0.2, 1, -0.3).normalized());
  ankle.X_PF = Eigen::Translation3d(0, 0.05, -0.4) * Exp(Vector3d(0.1, 0.4, -0.2));
  ankle.mass = 1;
  ankle.p_SB = {0.1, 0, -0.03};
  ankle.inertia = Vector3d(0.002, 0.005, 0.006).asDiagonal();
  for (const Segment& one : {bend, twist, shift, ankle}) description.segments.push_back(one);
  return KinematicModel(description);
}

/// By differences of poses.
double Energy(const KinematicModel& model, const Posture& at, const VectorXd& velocity) {
  constexpr double kStep = 1e-5;
  Posture before = at, after = at;
  before.joint_angles -= kStep * velocity;
  after.joint_angles += kStep * velocity;
  const auto X0 = SegmentPoses(model, before);
  const auto X = SegmentPoses(model, at);
  const auto X1 = SegmentPoses(model, after);
  double energy = 0;
  for (std::size_t i = 0; i < X.size(); ++i) {
    const Segment& one = model.segments()[i];
    const Vector3d v = (X1[i] * one.p_SB - X0[i] * one.p_SB) / (2 * kStep);
    const Vector3d w_S = Log(Eigen::Quaterniond(X0[i].linear().transpose() * X1[i].linear())) /
                         (2 * kStep);  // near enough the body's axes
    energy += 0.5 * one.mass * v.squaredNorm() + 0.5 * w_S.dot(one.inertia * w_S) +
              kG * one.mass * (X[i] * one.p_SB).z();
  }
  return energy;
}

TEST(InverseDynamicsTest, PowerIsTheChangeOfEnergy) {
  const KinematicModel model = Knee();
  ASSERT_EQ(model.num_joints(), 2);
  Posture posture = ZeroPosture(model);
  posture.joint_angles << 0.4, -0.7;
  for (const Eigen::Vector2d& velocity :
       {Eigen::Vector2d(1.3, 0), Eigen::Vector2d(0, 2), Eigen::Vector2d(-0.9, 1.7)}) {
    const Eigen::Vector2d acceleration(2, -3);
    VectorXd v = Vector(2, 0), a = Vector(2, 0);
    v.tail(2) = velocity;
    a.tail(2) = acceleration;
    const VectorXd forces = InverseDynamics(model, posture, v, a, {});
    constexpr double kStep = 1e-4;
    const auto energy = [&](double t) {
      Posture then = posture;
      then.joint_angles += t * velocity + 0.5 * t * t * acceleration;
      return Energy(model, then, velocity + t * acceleration);
    };
    EXPECT_NEAR(forces.tail(2).dot(velocity), (energy(kStep) - energy(-kStep)) / (2 * kStep), 2e-5);
  }
}

TEST(InverseDynamicsTest, AWrenchIsCarriedByTheJoints) {
  const KinematicModel model = Knee();
  Posture posture = ZeroPosture(model);
  posture.joint_angles << 0.4, -0.7;
  const Vector3d force(30, -20, 500), free_moment(1, 2, 3);
  const Vector3d p_W = SegmentPoses(model, posture).back() * Vector3d(0.1, 0.02, -0.05);
  const VectorXd rest = Vector(2, 0);
  const VectorXd with =
      InverseDynamics(model, posture, rest, rest, {{4, force, p_W.cross(force) + free_moment}});
  const VectorXd without = InverseDynamics(model, posture, rest, rest, {});
  constexpr double kStep = 1e-6;
  for (int j = 0; j < 2; ++j) {
    Posture before = posture, after = posture;
    before.joint_angles[j] -= kStep;
    after.joint_angles[j] += kStep;
    const Eigen::Isometry3d X0 = SegmentPoses(model, before).back();
    const Eigen::Isometry3d X1 = SegmentPoses(model, after).back();
    const Vector3d p_S(0.1, 0.02, -0.05);
    const Vector3d turn =
        X0.linear() * Log(Eigen::Quaterniond(X0.linear().transpose() * X1.linear()));
    const double work = force.dot(X1 * p_S - X0 * p_S) + free_moment.dot(turn);
    EXPECT_NEAR(with[6 + j] - without[6 + j], -work / (2 * kStep), 1e-6);
  }
  EXPECT_NEAR((with - without).head<3>().dot(Vector3d::UnitZ()), -500, kExact * 1e3);
}

TEST(SplineDerivativesTest, AreThoseOfThePolynomial) {
  constexpr double kRate = 50;
  Eigen::MatrixXd values(101, 2);
  for (int k = 0; k < values.rows(); ++k) {
    const double t = k / kRate - 1;
    values.row(k) << std::pow(t, 5) - t * t, 3 * t + 1;
  }
  const SplineDerivatives found = DifferentiateSplines(values, kRate);
  for (int k = 30; k < 71; ++k) {
    const double t = k / kRate - 1;
    EXPECT_NEAR(found.first(k, 0), 5 * std::pow(t, 4) - 2 * t, 1e-6);
    EXPECT_NEAR(found.second(k, 0), 20 * std::pow(t, 3) - 2, 1e-4);
  }
  EXPECT_LT((found.first.col(1).array() - 3).abs().maxCoeff(), 1e-9);  // at the ends too
  EXPECT_LT(found.second.col(1).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(SplineDerivativesTest, ASpinHasItsAngularVelocity) {
  PoseTrajectory motion;
  motion.rate = 100;
  const Vector3d axis = Vector3d(1, 2, 2) / 3;
  for (int k = 0; k < 200; ++k) {
    const double t = k / motion.rate;
    Posture posture;
    posture.orientation = Exp(Vector3d(2 * t * t * axis));
    if (k % 2 == 1) posture.orientation.coeffs() *= -1;
    motion.postures.push_back(posture);
  }
  DifferentiateSplines(&motion);
  EXPECT_LT((motion.velocities.col(100).tail<3>() - 4 * axis).norm(), 1e-6);
  EXPECT_LT((motion.accelerations.col(100).tail<3>() - 4 * axis).norm(), 1e-4);
}

}  // namespace
}  // namespace mmm_converter
