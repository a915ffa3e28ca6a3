// SPDX-License-Identifier: MIT
#include "common/retarget/retarget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "common/io/mesh/mesh_file.h"
#include "common/io/mmm/mmm_motion.h"
#include "common/io/robot/robot_file.h"
#include "common/io/robot/robot_meshes.h"
#include "common/io/urdf/urdf_robot.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/motion/resampled.h"
#include "common/motion/synthetic_motion.h"
#include "common/retarget/guarded_follower.h"
#include "common/retarget/retarget_figures.h"
#include "common/support/error.h"
#include "tests/common/retarget/biped.h"
#include "tests/common/retarget/squat.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::MakeBiped;
using testing::Person;
using testing::SharedData;
using testing::Shuffle;
using testing::Squat;

constexpr double kDegree = std::numbers::pi / 180;

TEST(RetargetTest, ASquatIsASquatAndItsFeetStandStill) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  const RobotBody body = FindRobotBody(robot, {}, {});
  const Retargeted result = RetargetMotion(person, Squat(person), robot, body);
  EXPECT_TRUE(result.keeps_limits);
  const RetargetFigures figures = MeasureRetargeting(result, robot, body);
  EXPECT_EQ(figures.slide, 0);
  EXPECT_LT(figures.penetration, 3e-4);
  EXPECT_LT(std::abs(figures.floating), 3e-4);
  EXPECT_EQ(figures.position_breaks, 0);
  EXPECT_EQ(figures.velocity_breaks, 0);
  EXPECT_LT(figures.direction, 2 * kDegree);
  EXPECT_FALSE(figures.is_mirrored);
  EXPECT_FALSE(figures.is_backwards);
  const int knee = robot.model.FindJoint("left_knee");
  EXPECT_NEAR(result.motion.postures[50].joint_angles[knee], 1.0, 0.06);
  EXPECT_NEAR(result.motion.postures[100].joint_angles[knee], 0.0, 0.06);
}

TEST(RetargetTest, LimbsWhoseKneesAreTwoJointsPointAsThePersons) {
  const KinematicModel person = Person(1.75);
  testing::BipedShape shape;
  shape.halves_reversed = true;
  for (const double gap : {0.0, 0.04}) {
    shape.halves = gap;
    const Robot robot = MakeBiped(shape);
    const RobotBody body = FindRobotBody(robot, {}, {});
    const Retargeted result = RetargetMotion(person, Squat(person), robot, body);
    const int knee = robot.model.FindSegment("left_knee");
    const int ankle = robot.model.FindSegment("left_ankle_pitch");
    double most = 0;
    for (int k = 0; k < result.human.num_frames(); ++k) {
      const LimbPosture& leg = result.human.bodies[static_cast<std::size_t>(k)].legs[0];
      const auto X_WS = SegmentPoses(robot.model, result.motion.postures[k]);
      const Eigen::Vector3d shank = X_WS[knee].translation() - X_WS[ankle].translation();
      most = std::max(most, std::acos(shank.normalized().dot(LowerDirection(leg))));
    }
    EXPECT_LT(most, 4 * kDegree) << gap;
    EXPECT_LT(MeasureRetargeting(result, robot, body).direction, 2 * kDegree) << gap;
  }
}

TEST(RetargetTest, TurnsWithThePerson) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  const RobotBody body = FindRobotBody(robot, {}, {});
  PoseTrajectory motion = Squat(person);
  const Retargeted one = RetargetMotion(person, motion, robot, body);
  const Eigen::Isometry3d X =
      Eigen::Translation3d(1, 2, 0) * Eigen::AngleAxisd(2.2, Eigen::Vector3d::UnitZ());
  for (Posture& posture : motion.postures) {
    posture.position = X * posture.position;
    posture.orientation = X.linear() * posture.orientation;
  }
  const Retargeted other = RetargetMotion(person, motion, robot, body);
  for (int k = 0; k < 200; k += 10) {
    const Eigen::VectorXd difference =
        one.motion.postures[k].joint_angles - other.motion.postures[k].joint_angles;
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-3) << k;  // how far fits converge
  }
}

TEST(RetargetTest, AFixedTrunkMovesItsArms) {
  const KinematicModel person = Person(1.75);
  testing::BipedShape shape;
  shape.has_legs = false;
  const Robot robot = MakeBiped(shape);
  const RobotBody body = FindRobotBody(robot, {}, {});
  const Retargeted result = RetargetMotion(person, Squat(person), robot, body);
  EXPECT_LT(MeasureRetargeting(result, robot, body).direction, 1 * kDegree);
  EXPECT_LT(result.motion.postures[70].position.norm(), 1e-3);
}

TEST(RetargetTest, ARobotWhoseLegsAreNotUsedStandsOnThemAndSaysSo) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  BodyMapChoice arms;
  arms.arms = {LimbChoice{"left_shoulder_pitch", "left_elbow", "left_elbow"},
               LimbChoice{"right_shoulder_pitch", "right_elbow", "right_elbow"}};
  const RobotBody body = FindRobotBody(robot, arms, {});
  ASSERT_FALSE(body.feet);
  EXPECT_THAT(DoubtOf(robot, body), ::testing::HasSubstr("does not follow the person"));
  for (const bool follows : {false, true}) {
    const Retargeted result = follows ? FollowMotion(person, Squat(person), robot, body)
                                      : RetargetMotion(person, Squat(person), robot, body);
    for (const Posture& posture : result.motion.postures) {
      ASSERT_LT((posture.position - Eigen::Vector3d(0, 0, 0.8)).norm(), 1e-3) << follows;
    }
  }
}

TEST(RetargetTest, FeetStandStillAtTheRateOfAFile) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  const RobotBody body = FindRobotBody(robot, {}, {});
  const PoseTrajectory recorded = Squat(person);
  JointBounds none;
  none.upper.setConstant(recorded.postures[0].joint_angles.size(), INFINITY);
  none.velocity = none.upper;
  none.lower = -none.upper;
  const Retargeted own = RetargetMotion(person, recorded, robot, body);
  for (const double rate : {10.0, 30.0, 240.0}) {
    const PoseTrajectory motion = Resample(recorded, rate, none);
    const Retargeted result = RetargetMotion(person, motion, robot, body, {}, {&recorded});
    ASSERT_EQ(result.motion.num_frames(), motion.num_frames());
    const RetargetFigures figures = MeasureRetargeting(result, robot, body);
    EXPECT_EQ(figures.rate, rate);
    EXPECT_EQ(figures.slide, 0) << rate;
    EXPECT_LT(figures.penetration, 3e-4) << rate;
    EXPECT_EQ(figures.velocity_breaks, 0) << rate;
    // Contacts are the recording's.
    for (int k = 0; k < motion.num_frames(); ++k) {
      const auto at =
          static_cast<std::size_t>(std::min<std::ptrdiff_t>(std::lround(k * 100 / rate), 199));
      EXPECT_EQ(result.rests[0].heel[k], own.rests[0].heel[at]) << rate << " " << k;
    }
  }
}

TEST(RetargetTest, FrameByFrameFeetStandStillAndLimitsAreKept) {
  const KinematicModel person = Person(1.75);
  testing::BipedShape shape;
  shape.hip_velocity = 1.2;  // less than the squat's
  for (const double velocity : {20.0, 1.2}) {
    shape.hip_velocity = velocity;
    const Robot robot = MakeBiped(shape);
    const RobotBody body = FindRobotBody(robot, {}, {});
    const Retargeted result = FollowMotion(person, Squat(person), robot, body);
    const RetargetFigures figures = MeasureRetargeting(result, robot, body);
    EXPECT_LT(figures.slide, 0.02);  // where hips are too slow and brake
    EXPECT_LT(figures.penetration, 1e-3);
    EXPECT_LT(std::abs(figures.floating), 1e-3);
    EXPECT_EQ(figures.position_breaks, 0);
    EXPECT_EQ(figures.velocity_breaks, 0);
    EXPECT_LT(figures.direction, (velocity < 2 ? 8 : 2) * kDegree);
  }
}

TEST(RetargetTest, FeetThatSwingLowClearTheFloorAsThePersons) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  const RobotBody body = FindRobotBody(robot, {}, {});
  const Retargeted result = RetargetMotion(person, Shuffle(person, 0.3, 0.02), robot, body);
  const RetargetFigures figures = MeasureRetargeting(result, robot, body);
  EXPECT_EQ(figures.slide, 0);
  EXPECT_LT(figures.penetration, 3e-4);
  int swings = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k < result.human.num_frames(); ++k) {
      const PointState& heel = result.states.heels[i];
      const PointState& toe = result.states.toes[i];
      const double clearance = std::min(heel.height[k], toe.height[k]);
      if (toe.speed[k] < 0.8 || clearance < 0.01) continue;
      ++swings;
      // By as much as a stance may be off.
      EXPECT_GT(figures.feet[i].height[k], result.scale * clearance - 5e-4) << i << " " << k;
    }
  }
  EXPECT_GT(swings, 100);
}

TEST(AimWeightsTest, AreOfGroupsWithinBounds) {
  const AimWeights weights = ParseAimWeights("feet=2, hands = .5");
  EXPECT_EQ(weights.feet, 2);
  EXPECT_EQ(weights.hands, 0.5);
  EXPECT_EQ(weights.trunk, 1);
  EXPECT_EQ(weights.limbs, 1);
  for (const char* wrong : {"feet", "feet=", "=2", "foot=2", "feet=0", "feet=nan", "hands=1e9",
                            "trunk=-1", "feet=1,feet=2", "feet=2,"}) {
    EXPECT_THROW(ParseAimWeights(wrong), Error) << wrong;
  }
}

TEST(AimWeightsTest, AreLinesOfAFile) {
  const AimWeights weights = ParseAimWeightLines("# mine\nfeet = 2  # firm\r\n\nlimbs=.5", "w.txt");
  EXPECT_EQ(weights.feet, 2);
  EXPECT_EQ(weights.limbs, 0.5);
  EXPECT_EQ(weights.hands, 1);
  try {
    ParseAimWeightLines("feet=2\nfeet=3\n", "w.txt");
    ADD_FAILURE() << "two weights of feet";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "w.txt:2: feet has two weights; give one");
  }
}

TEST(AimWeightsTest, WhatWeighsMoreIsNearer) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  RobotBody body = FindRobotBody(robot, {}, {});
  const auto worst = [&](const AimWeights& weights) {
    body.weights = weights;
    const Retargeted result = RetargetMotion(person, Squat(person), robot, body);
    return MeasureRetargeting(result, robot, body).direction;
  };
  const double as_is = worst({});
  EXPECT_LT(worst({1, 1, 1, 25}), 0.8 * as_is);
  EXPECT_GT(worst({1, 1, 25, 1}), as_is);
}

/// Brings the left forearm to the trunk and beyond.
PoseTrajectory ArmAcross(const KinematicModel& person) {
  PoseTrajectory motion = Squat(person);
  motion.joint_names = {"LSy_joint", "LSz_joint", "LEx_joint"};
  for (std::size_t k = 0; k < motion.postures.size(); ++k) {
    const double part = std::sin(std::numbers::pi * static_cast<double>(k) / 199);
    motion.postures[k].joint_angles = part * Eigen::Vector3d(0, -1.4, 1.6);
    motion.postures[k].position = motion.postures[0].position;
  }
  return motion;
}

TEST(RetargetTest, BodiesThatWouldTouchAreKeptApartAndToldWhereTheyAreNot) {
  const KinematicModel person = Person(1.75);
  testing::BipedShape shape;
  shape.has_bodies = true;
  const Robot robot = MakeBiped(shape);
  const RobotBody body = FindRobotBody(robot, {}, {});
  ASSERT_FALSE(body.capsules.pairs.empty());
  RobotBody heedless = body;
  heedless.capsules.pairs.clear();
  const PoseTrajectory motion = ArmAcross(person);
  const Retargeted through = RetargetMotion(person, motion, robot, heedless);
  const RetargetFigures told = MeasureRetargeting(through, robot, body);
  ASSERT_FALSE(told.touches.empty());
  EXPECT_GT(told.touches[0].depth, 0.02);
  EXPECT_EQ(told.touches[0].first, "left_elbow_link");
  EXPECT_EQ(told.touches[0].second, "waist_link");
  const Retargeted beside = RetargetMotion(person, motion, robot, body);
  const RetargetFigures kept = MeasureRetargeting(beside, robot, body);
  EXPECT_TRUE(kept.touches.empty() || kept.touches[0].depth < 0.003);
}

TEST(RobotCapsulesTest, ABodyOfMeshesIsAsLargeAsItsInertiaSays) {
  // 0.1 x 0.04 x 0.04 m of 1000 kg/m^3 as URDF has it.
  const char* text = R"(<robot name="rod"><link name="base"/><joint name="turn" type="revolute">
<parent link="base"/><child link="rod"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<link name="rod"><inertial><origin xyz="0.2 0 0"/><mass value="0.16"/><inertia ixx="4.2667e-5"
 iyy="1.54667e-4" izz="1.54667e-4" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)";
  const RobotCapsules found = FindCapsules(ParseUrdfRobot(text, "rod.urdf"), {});
  ASSERT_EQ(found.bodies.size(), 1U);
  const CapsuleBody& rod = found.bodies[0];
  EXPECT_TRUE(rod.is_by_mass);
  ASSERT_EQ(rod.capsules.size(), 1U);
  EXPECT_NEAR(rod.capsules[0].radius, 0.02, 1e-6);
  EXPECT_NEAR((rod.capsules[0].a_S - rod.capsules[0].b_S).norm(), 0.06, 1e-5);
  // Another one across, 50 mm above.
  const Eigen::Isometry3d X(Eigen::Translation3d(0.2, -0.2, 0.05) *
                            Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  RobotCapsules two = {{rod, rod}, {{0, 1}}, {}};
  two.bodies[0].segment = 0;
  PlacedCapsules placed;
  PlaceCapsules(two, {Eigen::Isometry3d::Identity(), X}, &placed);
  const Touch touch = FindTouch(two, placed, {0, 1}, 0.1);
  EXPECT_NEAR(touch.depth, -0.01, 1e-5);
  EXPECT_LT((touch.p_second - touch.p_first - Eigen::Vector3d(0, 0, 0.05)).norm(), 1e-5);
}

TEST(RetargetTest, TooFewFramesAreRefused) {
  const KinematicModel person = Person(1.75);
  const Robot robot = MakeBiped({});
  PoseTrajectory motion = Squat(person);
  motion.postures.resize(2);
  EXPECT_THROW(RetargetMotion(person, motion, robot, FindRobotBody(robot, {}, {})), Error);
}

struct RealCase {
  const char* robot;
  const char* motion;
  double slide, direction;  ///< at most; [deg]
};

class RealRobotTest : public ::testing::TestWithParam<RealCase> {};

// Depth, floating and slide are bounded by what is wanted of any robot; directions by what is
// wanted of walking and of other motions. H1 has narrow hips and an ankle that does not roll.
TEST_P(RealRobotTest, FeetStandAndLimitsAreKept) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const RealCase& one = GetParam();
  const MmmMotionFile file = ReadMmmMotionFile(SharedData(one.motion));
  const MmmMotion& motion = file.motions.front();
  const Robot robot = ReadRobotFile(SharedData(one.robot));
  const RobotBody body = FindRobotBody(robot, {}, {});
  const Retargeted result =
      RetargetMotion(Person(motion.size.height.value_or(1.8)), motion.trajectory, robot, body);
  const RetargetFigures figures = MeasureRetargeting(result, robot, body);
  EXPECT_EQ(figures.position_breaks, 0);
  EXPECT_EQ(figures.velocity_breaks, 0);
  EXPECT_FALSE(figures.is_mirrored);
  EXPECT_FALSE(figures.is_backwards);
  EXPECT_TRUE(result.keeps_limits);
  EXPECT_LE(figures.penetration, 0.001);
  EXPECT_LE(figures.floating, 0.003);
  EXPECT_LE(figures.slide, one.slide);
  EXPECT_LE(figures.direction, one.direction * kDegree);
}

constexpr const char* kG1 = "robots/unitree_g1/g1_custom_collision_29dof.urdf";
constexpr const char* kT1 = "robots/booster_t1/T1_23dof.urdf";
constexpr const char* kH1 = "robots/unitree_h1/h1.urdf";
constexpr const char* kWalk = "mmm/motions_legacy/walking_medium01_motion395.xml";
constexpr const char* kTurn = "mmm/motions_legacy/test_mmm_subject314_40joints_100Hz.xml";
constexpr const char* kWave = "mmm/motions_mmm2/wave_left01.xml";
INSTANTIATE_TEST_SUITE_P(
    Robots, RealRobotTest,
    ::testing::Values(RealCase{kG1, kWalk, 0.01, 2.5}, RealCase{kG1, kTurn, 0.01, 2.5},
                      RealCase{kG1, kWave, 0.01, 2.5}, RealCase{kT1, kWalk, 0.01, 2.5},
                      RealCase{kT1, kTurn, 0.01, 2.5}, RealCase{kT1, kWave, 0.01, 2.5},
                      RealCase{kH1, kWalk, 0.01, 5}, RealCase{kH1, kTurn, 0.01, 5}));

/// Of a foot that does not tilt by more than a right angle; each once.
Eigen::Matrix3Xd LowerCorners(const std::string& file) {
  const Eigen::Matrix3Xd all = ReadMesh(file).points;
  std::set<std::array<double, 3>> distinct;
  for (const auto& p : all.colwise()) {
    if (p.z() < -0.02) distinct.insert({p.x(), p.y(), p.z()});
  }
  Eigen::Matrix3Xd corners(3, static_cast<Eigen::Index>(distinct.size()));
  Eigen::Index next = 0;
  for (const auto& p : distinct) corners.col(next++) << p[0], p[1], p[2];
  return corners;
}

// All corners of the feet's meshes, not only those that the fit knows.
TEST(RealRobotMeshTest, NoCornerOfAMeshIsInTheFloor) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  Robot robot = ReadRobotFile(SharedData("robots/unitree_h1/h1.xml"));
  const BodyMap map = FindRobotMap(robot, {});
  for (const auto& leg : map.legs) ReadMeshes(leg->end, &robot, nullptr);
  const RobotBody body = FindRobotBody(robot, {}, {});
  for (const char* name : {kWalk, kTurn, kWave}) {
    const MmmMotionFile file = ReadMmmMotionFile(SharedData(name));
    const MmmMotion& motion = file.motions.front();
    const Retargeted result =
        RetargetMotion(Person(motion.size.height.value_or(1.8)), motion.trajectory, robot, body);
    double lowest = 0;
    for (const Side side : kSides) {
      const Eigen::Matrix3Xd corners = LowerCorners(
          SharedData(std::string("robots/unitree_h1/meshes/") + Name(side) + "_ankle_link.STL"));
      const int foot = map.leg(side)->end;
      for (const Posture& posture : result.motion.postures) {
        const Eigen::Isometry3d X = SegmentPoses(robot.model, posture)[foot];
        lowest = std::min(lowest, (X.linear().row(2) * corners).minCoeff() + X.translation().z());
      }
    }
    EXPECT_GT(lowest, -0.001) << name;
    const RetargetFigures figures = MeasureRetargeting(result, robot, body);
    EXPECT_NEAR(figures.penetration, -lowest, 2e-4) << name;
    // An ankle that does not roll turns the round edges of a narrow foot otherwise than planned: by
    // 10 to 13 mm/s, where 10 are sliding.
    EXPECT_LE(figures.slide, std::string(name) == kTurn ? 0.07 : 0.02) << name;
    EXPECT_LE(figures.floating, 0.003) << name;
  }
}

}  // namespace
}  // namespace mmm_converter
