// SPDX-License-Identifier: MIT
// Textbook cases, and the laws that every motion obeys.
#include <gtest/gtest.h>

#include <cmath>

#include "common/dynamics/simbody_model.h"
#include "common/io/mmm/mmm_model.h"
#include "common/math/rotation.h"
#include "common/model/model_scaling.h"
#include "tests/common/dynamics/test_bodies.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Forces of 1e3 N by some 1e3 roundings.
constexpr double kRounding = 1e-9;

VectorXd RandomRates(Eigen::Index size, SeededRandom& random) {
  VectorXd rates(size);
  for (double& rate : rates) rate = random.Normal();
  return rates;
}

/// Everything a motion has at one instant.
struct Instant {
  Posture posture;
  VectorXd velocities;
  VectorXd accelerations;
};

/// `instant` after t seconds, to second order.
Instant After(Instant instant, double t) {
  const VectorXd step = t * instant.velocities + 0.5 * t * t * instant.accelerations;
  instant.posture.position += step.head<3>();
  instant.posture.orientation = Exp(step.segment<3>(3)) * instant.posture.orientation;
  instant.posture.joint_angles += step.tail(step.size() - 6);
  instant.velocities += t * instant.accelerations;
  return instant;
}

Instant RandomInstant(const KinematicModel& model, SeededRandom& random) {
  const Posture posture = testing::RandomPosture(model, random);
  const VectorXd velocities = RandomRates(6 + model.num_joints(), random);
  return {posture, velocities, RandomRates(6 + model.num_joints(), random)};
}

/// A point mass on a massless rod of length l below a frame that stands still, turned about x.
struct Pendulum {
  double m = 2;
  double l = 0.7;

  KinematicModel Model() const {
    ModelDescription description;
    description.name = "pendulum";
    description.segments.resize(2);
    description.segments[0].name = "frame";
    description.segments[0].mass = 5;
    description.segments[0].inertia = Matrix3d::Identity();
    description.segments[1].name = "rod";
    description.segments[1].parent = 0;
    description.segments[1].type = JointType::kRevolute;
    description.segments[1].axis = Vector3d::UnitX();
    description.segments[1].lower = -4;
    description.segments[1].upper = 4;
    description.segments[1].mass = m;
    description.segments[1].p_SB = {0, 0, -l};
    return KinematicModel(description);
  }
};

TEST(SimbodyDynamics, PendulumIsHeldByItsWeightTimesLever) {
  const Pendulum pendulum;
  const KinematicModel model = pendulum.Model();
  const SimbodyModel simbody(model);
  for (const double angle : {-2.0, -0.4, 0.0, 0.7, 1.5707963, 3.0}) {
    Posture posture = ZeroPosture(model);
    posture.joint_angles[0] = angle;
    const WholeBodyMotion held = simbody.Moving(posture, VectorXd::Zero(7), VectorXd::Zero(7));
    EXPECT_NEAR(held.forces[6], pendulum.m * kGravity * pendulum.l * std::sin(angle), kRounding);
    EXPECT_NEAR(held.forces[2], (pendulum.m + 5) * kGravity, kRounding);
    // The frame is held against the same moment; the rod swings to y for positive angles.
    EXPECT_NEAR(held.forces[3], held.forces[6], kRounding);
  }
}

TEST(SimbodyDynamics, FreePendulumAcceleratesByTheSineAndPullsByTheSpeed) {
  const Pendulum pendulum;
  const KinematicModel model = pendulum.Model();
  const SimbodyModel simbody(model);
  const double angle = 0.9;
  const double speed = 2.5;
  Posture posture = ZeroPosture(model);
  posture.joint_angles[0] = angle;
  VectorXd velocities = VectorXd::Zero(7);
  velocities[6] = speed;
  VectorXd accelerations = VectorXd::Zero(7);
  accelerations[6] = -kGravity / pendulum.l * std::sin(angle);
  const WholeBodyMotion free = simbody.Moving(posture, velocities, accelerations);
  EXPECT_NEAR(free.forces[6], 0, kRounding);
  EXPECT_NEAR(free.kinetic_energy, 0.5 * pendulum.m * std::pow(pendulum.l * speed, 2), kRounding);
  // The rod points along (0, sin, -cos) and pulls the frame with m (g cos + l speed^2).
  const double pull = pendulum.m * (kGravity * std::cos(angle) + pendulum.l * speed * speed);
  EXPECT_NEAR(free.forces[1], -pull * std::sin(angle), kRounding);
  EXPECT_NEAR(free.forces[2], pull * std::cos(angle) + 5 * kGravity, kRounding);
  EXPECT_LT((simbody.Accelerations(posture, velocities, free.forces) - accelerations).norm(),
            kRounding);
}

TEST(SimbodyDynamics, ABodyThatNothingTouchesFalls) {
  const KinematicModel model = testing::Chain(5);
  const SimbodyModel simbody(model);
  SeededRandom random(11);
  for (int trial = 0; trial < 10; ++trial) {
    Instant instant = RandomInstant(model, random);
    instant.accelerations =
        simbody.Accelerations(instant.posture, instant.velocities, VectorXd::Zero(11));
    const WholeBodyMotion body =
        simbody.Moving(instant.posture, instant.velocities, instant.accelerations);
    EXPECT_LT(body.forces.norm(), kRounding);
    const double h = 1e-4;
    const Instant before = After(instant, -h);
    const Instant after = After(instant, h);
    const WholeBodyMotion b = simbody.Moving(before.posture, before.velocities, VectorXd::Zero(11));
    const WholeBodyMotion a = simbody.Moving(after.posture, after.velocities, VectorXd::Zero(11));
    // Central differences: h^2 times third derivatives of up to 1e2.
    EXPECT_LT(((a.center_of_mass_velocity - b.center_of_mass_velocity) / (2 * h) +
               kGravity * Vector3d::UnitZ())
                  .norm(),
              1e-5);
    EXPECT_LT((a.angular_momentum - b.angular_momentum).norm() / (2 * h), 1e-5);
  }
}

TEST(SimbodyDynamics, ASpinningBodyObeysEuler) {
  const KinematicModel model = testing::Brick();
  const SimbodyModel simbody(model);
  const Segment& brick = model.segments()[0];
  SeededRandom random(5);
  for (int trial = 0; trial < 10; ++trial) {
    const Instant instant = RandomInstant(model, random);
    const Matrix3d R = instant.posture.orientation.toRotationMatrix();
    const Vector3d omega = R.transpose() * instant.velocities.tail<3>();  // in the body
    const VectorXd free =
        simbody.Accelerations(instant.posture, instant.velocities, VectorXd::Zero(6));
    const Vector3d euler = brick.inertia.inverse() * -omega.cross(brick.inertia * omega);
    EXPECT_LT((R.transpose() * free.tail<3>() - euler).norm(), kRounding);
    const WholeBodyMotion body = simbody.Moving(instant.posture, instant.velocities, free);
    EXPECT_LT((body.angular_momentum - R * brick.inertia * omega).norm(), kRounding);
    EXPECT_NEAR(body.segment_angular_momentum, body.angular_momentum.norm(), kRounding);
  }
}

TEST(SimbodyDynamics, ForwardUndoesInverse) {
  const KinematicModel model = testing::Chain(6);
  const SimbodyModel simbody(model);
  SeededRandom random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Instant instant = RandomInstant(model, random);
    const VectorXd forces =
        simbody.Moving(instant.posture, instant.velocities, instant.accelerations).forces;
    EXPECT_LT(
        (simbody.Accelerations(instant.posture, instant.velocities, forces) - instant.accelerations)
            .norm(),
        kRounding);
  }
}

/// Newton's, Euler's and the energy's laws by central differences along a motion, which also fix
/// the frames of all velocities and forces.
void ExpectLawsOfMotion(const KinematicModel& model, double tolerance) {
  const SimbodyModel simbody(model);
  SeededRandom random(17);
  const double h = 1e-4;
  for (int trial = 0; trial < 5; ++trial) {
    const Instant now = RandomInstant(model, random);
    const WholeBodyMotion body = simbody.Moving(now.posture, now.velocities, now.accelerations);
    const Instant past = After(now, -h);
    const Instant next = After(now, h);
    const WholeBodyMotion b = simbody.Moving(past.posture, past.velocities, past.accelerations);
    const WholeBodyMotion a = simbody.Moving(next.posture, next.velocities, next.accelerations);
    const auto rate = [h](const Vector3d& after, const Vector3d& before) -> Vector3d {
      return (after - before) / (2 * h);
    };
    EXPECT_LT(
        (rate(simbody.At(next.posture).center_of_mass, simbody.At(past.posture).center_of_mass) -
         body.center_of_mass_velocity)
            .norm(),
        tolerance);
    const double mass = model.total_mass();
    const Vector3d force = body.forces.head<3>();
    EXPECT_LT(
        (rate(a.linear_momentum, b.linear_momentum) + mass * kGravity * Vector3d::UnitZ() - force)
            .norm(),
        tolerance * mass);
    const Vector3d from_root = body.center_of_mass - now.posture.position;
    const Vector3d moment = body.forces.segment<3>(3) - from_root.cross(force);
    EXPECT_LT((rate(a.angular_momentum, b.angular_momentum) - moment).norm(), tolerance * mass);
    const auto energy = [mass](const WholeBodyMotion& w) {
      return w.kinetic_energy + mass * kGravity * w.center_of_mass.z();
    };
    const double power = body.forces.dot(now.velocities);
    EXPECT_NEAR((energy(a) - energy(b)) / (2 * h), power, tolerance * mass * 10);
  }
}

// Tolerances: central differences leave h^2 = 1e-8 times third derivatives, which grow with the
// cube of the rates summed along a chain: 1e2 for six joints, 1e4 for a body of 90 at 1 rad/s each.

TEST(SimbodyDynamics, ObeysTheLawsOfMotionOnAChain) { ExpectLawsOfMotion(testing::Chain(6), 1e-5); }

TEST(SimbodyDynamics, ObeysTheLawsOfMotionOnJointsThatFollowOthers) {
  ExpectLawsOfMotion(testing::CoupledChain(), 1e-5);
}

TEST(SimbodyDynamics, ObeysTheLawsOfMotionOnThePersonsModel) {
  const KinematicModel read = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  ExpectLawsOfMotion(ScaleWinter(read, {1.75, 70, {}}), 1e-4);
}

}  // namespace
}  // namespace mmm_converter
