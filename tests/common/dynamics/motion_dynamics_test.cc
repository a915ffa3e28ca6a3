// SPDX-License-Identifier: MIT
#include "common/dynamics/motion_dynamics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/io/mmm/mmm_model.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/math/rotation.h"
#include "common/model/model_scaling.h"
#include "common/motion/synthetic_motion.h"
#include "common/support/error.h"
#include "tests/common/dynamics/test_bodies.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kRate = 100;

/// The brick stands for a second, is thrown up for half a second and stands again; its centre of
/// mass flies on a parabola, and it turns by a full turn about its upright axis.
PoseTrajectory ThrownBrick(const KinematicModel& model) {
  PoseTrajectory motion;
  motion.rate = kRate;
  const Vector3d p_SB = model.segments()[0].p_SB;
  for (int k = 0; k < 250; ++k) {
    const double t = std::clamp((k - 100) / kRate, 0.0, 0.5);
    Posture q;
    q.orientation = Exp({0, 0, 4 * std::acos(-1.0) * t});
    const Vector3d com = Vector3d(1, 2, 0.25) + t * Vector3d(0.8, -0.3, 0.25 * kGravity) -
                         0.5 * kGravity * t * t * Vector3d::UnitZ();
    q.position = com - q.orientation * p_SB;
    q.joint_angles.resize(0);
    motion.postures.push_back(q);
  }
  return motion;
}

TEST(MotionDynamics, EndsBetweenTwoFrames) {
  const KinematicModel model = testing::Brick();
  int last = -1;
  const auto stop = [&last](int done, int all) {
    EXPECT_EQ(all, 250);
    last = done;
    if (done == 7) throw Error("enough");
  };
  EXPECT_THROW(ComputeMotionDynamics(model, ThrownBrick(model), {}, stop), Error);
  EXPECT_EQ(last, 7);
}

TEST(MotionDynamics, AThrownBodyFallsWithG) {
  const KinematicModel model = testing::Brick();
  const MotionDynamics dynamics = ComputeMotionDynamics(model, ThrownBrick(model));
  EXPECT_NEAR(dynamics.ground_height, 0, 1e-12);
  ASSERT_EQ(dynamics.ballistic_phases.size(), 1U);
  const BallisticPhase& flight = dynamics.ballistic_phases[0];
  // 4 cm above the ground: 16.9 ms after the start and before the end.
  EXPECT_EQ(flight.begin, 102);
  EXPECT_EQ(flight.end, 149);
  // The postures are exact: rounding only, in metres by 0.25 s squared.
  EXPECT_LT((flight.acceleration + kGravity * Vector3d::UnitZ()).norm(), 1e-10);
  EXPECT_LT(flight.parabola_rms, 1e-12);
  // What the low-pass leaves of start and landing reaches some 1/6 s into the flight; its middle is
  // free of it to a few per cent.
  EXPECT_LT(dynamics.residual_force.col(125).norm(), 0.05 * dynamics.body_weight());
  EXPECT_NEAR(dynamics.angular_momentum(2, 125), 0.04 * 4 * std::acos(-1.0), 0.02);
  EXPECT_NEAR(dynamics.residual_force(2, 50), dynamics.body_weight(),
              0.02 * dynamics.body_weight());
}

TEST(MotionDynamics, FramesAreDifferentiatedWithThoseBesideThem) {
  const KinematicModel model = testing::Brick();
  const PoseTrajectory motion = ThrownBrick(model);
  const MotionDynamics whole = ComputeMotionDynamics(model, motion);
  DynamicsOptions options;
  options.first_frame = 90;
  options.end_frame = 240;
  const MotionDynamics part = ComputeMotionDynamics(model, motion, options);
  ASSERT_EQ(part.num_frames(), 150);
  EXPECT_DOUBLE_EQ(part.time(0), whole.time(90));
  EXPECT_EQ(part.residual_force, whole.residual_force.middleCols(90, 150));
  EXPECT_EQ(part.residual_moment, whole.residual_moment.middleCols(90, 150));
  EXPECT_EQ(part.contacts, whole.contacts.middleCols(90, 150));
  EXPECT_EQ(part.ballistic_phases.at(0).begin, whole.ballistic_phases.at(0).begin - 90);
  // A period of 6 Hz: 16.7 frames at the recording's own ends.
  EXPECT_EQ(whole.settled_begin, 17);
  EXPECT_EQ(whole.settled_end, 233);
  EXPECT_EQ(part.settled_begin, 0);
  EXPECT_EQ(part.settled_end, 143);
}

TEST(MotionDynamics, GivenDerivativesAreUsedAsTheyAre) {
  const KinematicModel model = testing::Chain(3);
  const SimbodyModel simbody(model);
  PoseTrajectory motion;
  motion.rate = kRate;
  motion.joint_names = {"link_2"};
  motion.postures.assign(6, ZeroPosture(model));
  motion.velocities.setZero(7, 6);
  motion.accelerations.setZero(7, 6);
  for (int k = 0; k < 6; ++k) {
    motion.postures[k].joint_angles = Eigen::VectorXd::Constant(1, 0.1 * k);
    motion.velocities(6, k) = k;
    motion.accelerations(6, k) = 2 * k;
  }
  const MotionDynamics dynamics = ComputeMotionDynamics(model, motion);
  EXPECT_EQ(dynamics.differentiation.source, DerivativeSource::kMotion);
  EXPECT_THAT(dynamics.joint_names, ElementsAre("link_1", "link_2", "link_3"));
  Posture posture = ZeroPosture(model);
  posture.joint_angles[1] = 0.4;
  Eigen::VectorXd velocities = Eigen::VectorXd::Zero(9);
  velocities[7] = 4;
  const WholeBodyMotion body = simbody.Moving(posture, velocities, 2 * velocities);
  EXPECT_EQ(dynamics.residual_force.col(4), body.forces.head<3>());
  EXPECT_EQ(dynamics.residual_root_moment.col(4), body.forces.segment<3>(3));
  EXPECT_EQ(dynamics.joint_torques.col(4), body.forces.tail<3>());
  EXPECT_EQ(dynamics.joint_power(1, 4), 4 * body.forces[7]);
  EXPECT_EQ(dynamics.joint_power(0, 4), 0);
}

TEST(MotionDynamics, LowersTheCutoffToWhatTheRateAllows) {
  const KinematicModel model = testing::Brick();
  PoseTrajectory motion = ThrownBrick(model);
  EXPECT_EQ(ComputeMotionDynamics(model, motion).differentiation.cutoff, 6);
  EXPECT_FALSE(ComputeMotionDynamics(model, motion).differentiation.cutoff_lowered);
  motion.rate = 10;
  const Differentiation slow = ComputeMotionDynamics(model, motion).differentiation;
  EXPECT_EQ(slow.cutoff, 4);
  EXPECT_TRUE(slow.cutoff_lowered);
}

TEST(MotionDynamics, TellsWhatDifferentiationDoesToNoise) {
  const KinematicModel model = testing::Brick();
  PoseTrajectory motion = ThrownBrick(model);
  motion.postures.resize(100);
  SeededRandom random(1);
  for (Posture& q : motion.postures) q.position.x() += 0.001 * random.Normal();
  const Differentiation noisy = ComputeMotionDynamics(model, motion).differentiation;
  // Second differences of white noise have sqrt(6) times its deviation: 0.001 * sqrt(6) * 100^2 /
  // g.
  EXPECT_NEAR(noisy.raw_force_rms, 2.5,
              0.4);  // of 100 frames: a tenth, by correlation somewhat more
  EXPECT_LT(noisy.force_rms, 0.02 * noisy.raw_force_rms);  // (12/100)^2.5, what 6 Hz leave of it
  // The estimate of what noise makes: all that is left after 6 Hz, as the body stands. White noise
  // of 100 frames has few periods of it: to a factor of two.
  EXPECT_GT(noisy.noise_force_rms, 0.5 * noisy.force_rms);
  EXPECT_LT(noisy.noise_force_rms, 2 * noisy.force_rms);
  DynamicsOptions raw;
  raw.cutoff = 0;
  const Differentiation unfiltered = ComputeMotionDynamics(model, motion, raw).differentiation;
  EXPECT_NEAR(unfiltered.noise_force_rms, noisy.raw_force_rms, 0.05 * noisy.raw_force_rms);
  EXPECT_NEAR(unfiltered.force_rms, noisy.raw_force_rms,
              0.05 * noisy.raw_force_rms);  // 2 end frames
}

TEST(MotionDynamics, HoldsAnglesThatAreNotKnown) {
  const KinematicModel model = testing::Chain(1);
  PoseTrajectory motion;
  motion.rate = kRate;
  motion.joint_names = {"link_1"};
  motion.postures.assign(10, ZeroPosture(model));
  for (int k = 0; k < 10; ++k) motion.postures[k].joint_angles[0] = k < 3 ? std::nan("") : 0.2;
  const MotionDynamics dynamics = ComputeMotionDynamics(model, motion);
  EXPECT_EQ(dynamics.frames_with_held_joints, 3);
  EXPECT_TRUE(dynamics.joint_torques.allFinite());
  EXPECT_LT(dynamics.com_velocity.norm(), 1e-9);  // held still: rounding
}

TEST(MotionDynamics, RefusesWhatHasNoDynamics) {
  const KinematicModel model = testing::Brick();
  PoseTrajectory motion = ThrownBrick(model);
  motion.postures.resize(4);
  EXPECT_THAT([&] { ComputeMotionDynamics(model, motion); },
              ThrowsMessage<Error>(HasSubstr("has 4 frames; at least 5")));
  motion = ThrownBrick(model);
  motion.joint_names = {"tail_joint"};
  EXPECT_THAT([&] { ComputeMotionDynamics(model, motion); },
              ThrowsMessage<Error>(HasSubstr("'tail_joint', which model 'brick'")));
  ModelDescription massless;
  massless.name = "ghost";
  massless.segments.resize(1);
  massless.segments[0].name = "root";
  EXPECT_THAT([&] { ComputeMotionDynamics(KinematicModel(massless), ThrownBrick(model)); },
              ThrowsMessage<Error>(HasSubstr("model 'ghost' has no mass")));
}

KinematicModel Person(double height, double mass) {
  const KinematicModel read = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  return ScaleWinter(read, {height, mass, {}});
}

int BodyIndex(const MotionDynamics& dynamics, const std::string& name) {
  const auto& bodies = dynamics.contact_bodies;
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const ContactBody& body) { return body.name == name; });
  return static_cast<int>(found - bodies.begin());
}

TEST(MotionDynamics, AHandstandStandsOnItsHands) {
  const KinematicModel model = Person(1.75, 70);
  const PoseTrajectory motion = MakeHandstand(model);
  const MotionDynamics dynamics = ComputeMotionDynamics(model, motion);
  // The motion's floor is z = 0, which the lowest points of feet and hands do not all lie on.
  EXPECT_NEAR(dynamics.ground_height, 0, 0.03);
  const int highest = [&] {
    Index frame = 0;
    dynamics.contact_heights.row(BodyIndex(dynamics, "left foot")).maxCoeff(&frame);
    return static_cast<int>(frame);
  }();
  EXPECT_GT(dynamics.contact_heights(BodyIndex(dynamics, "right foot"), highest), 1.5);
  for (const int frame : {10, highest, motion.num_frames() - 10}) {
    const int on_hands = frame == highest ? 1 : 0;
    EXPECT_EQ(dynamics.contacts(BodyIndex(dynamics, "left hand"), frame), on_hands);
    EXPECT_EQ(dynamics.contacts(BodyIndex(dynamics, "right hand"), frame), on_hands);
    EXPECT_EQ(dynamics.contacts(BodyIndex(dynamics, "left foot"), frame), 1 - on_hands);
    EXPECT_EQ(dynamics.contacts(BodyIndex(dynamics, "right foot"), frame), 1 - on_hands);
  }
  EXPECT_TRUE(dynamics.ballistic_phases.empty());
  constexpr int kEarly = 3;  // [frames] by which a low-pass of 6 Hz has the force of a landing foot
  for (int k = dynamics.settled_begin; k < dynamics.settled_end; ++k) {
    const auto touches = dynamics.contacts.middleCols(k, kEarly + 1).topRows(2);
    if ((touches.rightCols(1).array() > touches.leftCols(1).array()).any()) continue;
    // What check-dynamics takes as standing is 0.1.
    EXPECT_LT(dynamics.outside_support[k], 0.06) << "tips over in frame " << k;
  }
}

TEST(MotionDynamicsRealFiles, ARealWalkIsCarriedByTheFeet) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MmmMotionFile file =
      ReadMmmMotionFile(testing::SharedData("mmm/motions_legacy/walking_medium01_motion395.xml"));
  const MmmMotion& walk = file.motions.front();
  const MotionDynamics dynamics =
      ComputeMotionDynamics(Person(*walk.size.height, *walk.size.mass), walk.trajectory);
  EXPECT_LT(dynamics.kinematics.marker_distance, 1e-9);
  EXPECT_LT(dynamics.kinematics.segment_distance, 1e-9);
  EXPECT_LT(dynamics.kinematics.segment_angle, 1e-9);
  const Eigen::ArrayXd lift =
      dynamics.residual_force.row(2).transpose().array() / dynamics.body_weight();
  // The laws of a walk, not of this one: over whole steps the ground carries the weight, as the
  // centre of mass comes back to its height; within a step the force swings about it.
  const int left = BodyIndex(dynamics, "left foot");
  std::vector<int> touchdowns;
  for (int k = 1; k < dynamics.num_frames(); ++k) {
    if (dynamics.contacts(left, k) > dynamics.contacts(left, k - 1)) touchdowns.push_back(k);
  }
  ASSERT_GE(touchdowns.size(), 2U);
  const int begin = touchdowns.front();
  const int stride = touchdowns.back() - begin;
  EXPECT_NEAR(lift.segment(begin, stride).mean(), 1, 0.05);
  EXPECT_LT(lift.segment(begin, stride).minCoeff(), 0.95);
  EXPECT_GT(lift.segment(begin, stride).maxCoeff(), 1.1);
  // The centre of pressure, from the masses' motion alone, lies below the feet, found from heights
  // alone; what the ends of the recording do to its derivatives is left out.
  const Eigen::ArrayXd outside = dynamics.outside_support.segment(20, dynamics.num_frames() - 40);
  EXPECT_GT((outside < 0.02).count(), 0.9 * static_cast<double>(outside.size()));
  EXPECT_TRUE(dynamics.ballistic_phases.empty());
}

}  // namespace
}  // namespace mmm_converter
