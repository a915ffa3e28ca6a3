// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/pipeline/retarget_verdict.h"
#include "common/retarget/follow_figures.h"
#include "common/retarget/guarded_follower.h"
#include "common/retarget/held_joints.h"
#include "common/retarget/held_objects.h"
#include "common/retarget/retarget.h"
#include "common/retarget/retarget_figures.h"
#include "common/support/error.h"
#include "tests/common/retarget/biped.h"
#include "tests/common/retarget/squat.h"

namespace mmm_converter {
namespace {

using testing::MakeBiped;
using testing::Person;
using testing::Squat;

constexpr double kPerDegree = std::numbers::pi / 180;

TEST(RetargetTest, FingersStayWhereTheyAreHeldOrAtRest) {
  const KinematicModel person = Person(1.75);
  testing::BipedShape shape;
  shape.has_fingers = true;
  const Robot robot = MakeBiped(shape);
  RobotBody body = FindRobotBody(robot, {}, {});
  HoldJoints(robot, "*_finger_?=30,left_finger_2=80,right_thumb=-20", &body);
  const PoseTrajectory motion = Squat(person);
  for (const bool follows : {false, true}) {
    const Retargeted result = follows ? FollowMotion(person, motion, robot, body)
                                      : RetargetMotion(person, motion, robot, body);
    const std::vector<std::pair<const char*, double>> held = {{"left_finger_1", 30},
                                                              {"right_finger_1", 30},
                                                              {"left_finger_2", 80},
                                                              {"right_thumb", -20},
                                                              {"left_thumb", 0}};
    for (const auto& [name, angle] : held) {
      const int joint = robot.model.FindJoint(name);
      for (const Posture& posture : result.motion.postures) {
        ASSERT_NEAR(posture.joint_angles[joint], angle * kPerDegree, 1e-5) << name;
      }
    }
    EXPECT_LT(MeasureRetargeting(result, robot, body).direction, 2 * kPerDegree);
  }
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      HoldJoints(robot, text, &body);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("left_fingr_1=3"), ::testing::HasSubstr("did you mean left_finger_1?"));
  EXPECT_THAT(refusal("*_finger_1=0"), ::testing::HasSubstr("5.73 to 85.94 degrees"));
  EXPECT_THAT(refusal("left_knee=10"), ::testing::HasSubstr("of a leg"));
  for (const char* text : {"thumb", "=3", "left_thumb=x", "left_thumb=nan", "left_thumb=1,"}) {
    EXPECT_NE(refusal(text), "") << text;
  }
}

TEST(RetargetTest, SolesAreWhereHeldToesAre) {
  testing::BipedShape shape;
  shape.has_toes = true;
  Robot robot = MakeBiped(shape);
  RobotBody body = FindRobotBody(robot, {}, {});
  HoldJoints(robot, "*toes=-25", &body);
  ASSERT_TRUE(BendFeet(body, &robot.model));
  body = FindRobotBody(robot, {}, {});
  HoldJoints(robot, "*toes=-25", &body);
  const PoseTrajectory motion = Squat(Person(1.75));
  const Retargeted result = RetargetMotion(Person(1.75), motion, robot, body);
  const int toes = robot.model.FindSegment("left_toes");
  for (const Posture& posture : result.motion.postures) {
    ASSERT_NEAR(posture.joint_angles[robot.model.FindJoint("left_toes")], -25 * kPerDegree, 1e-5);
    const auto X_WS = SegmentPoses(robot.model, posture);
    double lowest = INFINITY;
    for (const ContactShape& one : robot.shapes) {
      if (one.segment != toes && one.segment != (*body.feet)[0].segment) continue;
      lowest = std::min(lowest, LowestHeight(one, X_WS[one.segment]));
    }
    ASSERT_NEAR(LowestOf((*body.feet)[0], X_WS[(*body.feet)[0].segment]), lowest, 1e-9);
    ASSERT_NEAR(lowest, 0, 5e-4);
  }
}

TEST(RetargetTest, WhatTouchesWhereJointsAreHeldIsNotWatched) {
  testing::BipedShape shape;
  shape.has_bodies = true;
  const Robot robot = MakeBiped(shape);
  RobotBody body = FindRobotBody(robot, {}, {});
  const auto watches = [&](const std::string& first, const std::string& second) {
    const auto& bodies = body.capsules.bodies;
    return std::any_of(
        body.capsules.pairs.begin(), body.capsules.pairs.end(), [&](const auto& pair) {
          const std::string &a = bodies[pair.first].name, &b = bodies[pair.second].name;
          return (a == first && b == second) || (a == second && b == first);
        });
  };
  EXPECT_TRUE(watches("left_elbow_link", "waist_link"));
  const std::size_t balls = body.balls.size();
  HoldJoints(robot, "left_shoulder_roll=-30", &body);  // into the trunk
  EXPECT_FALSE(watches("left_elbow_link", "waist_link"));
  EXPECT_TRUE(watches("right_elbow_link", "waist_link"));
  EXPECT_EQ(body.balls.size(), balls);
}

/// What the left hand takes from one place to another between two frames, and a table.
std::vector<TrackedObject> CupOnTable(const KinematicModel& person, const PoseTrajectory& motion,
                                      int begin, int end) {
  const HumanMotion human = MoveHuman(person, FindHumanBody(person), motion);
  const Eigen::Isometry3d X_HO(Eigen::Translation3d(0.02, -0.03, -0.02) *
                               Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
  TrackedObject cup, table;
  cup.name = "cup";
  table.name = "table";
  for (int k = 0; k < human.num_frames(); ++k) {
    const LimbPosture& arm = human.bodies[std::clamp(k, begin, end - 1)].arms[0];
    Eigen::Isometry3d X_WH = Eigen::Isometry3d::Identity();
    X_WH.linear() = arm.R_end;
    X_WH.translation() = PalmOf(arm);
    cup.X_WO.push_back(X_WH * X_HO);
    table.X_WO.emplace_back(Eigen::Translation3d(0.5, 0.2, 0.7));
  }
  cup.end = table.end = human.num_frames();
  cup.extent = {Eigen::Vector3d(-0.04, -0.04, -0.06), Eigen::Vector3d(0.04, 0.04, 0.06)};
  table.extent = {Eigen::Vector3d(-0.4, -0.4, -0.02), Eigen::Vector3d(0.4, 0.4, 0)};
  return {cup, table};
}

TEST(RetargetTest, HandsKeepTheirPlaceAtWhatTheyHold) {
  const KinematicModel person = Person(1.75);
  PoseTrajectory motion = Squat(person);
  for (Posture& posture : motion.postures) posture.joint_angles.tail<1>() *= 1.5;
  const Robot robot = MakeBiped({});
  const RobotBody body = FindRobotBody(robot, {}, {});
  const auto objects = CupOnTable(person, motion, 20, 80);
  const Retargeted result = RetargetMotion(person, motion, robot, body, objects);
  ASSERT_EQ(result.holds.size(), 1U);
  EXPECT_EQ(result.holds[0].hand, 0U);
  EXPECT_EQ(result.holds[0].object, 0);
  EXPECT_NEAR(result.holds[0].begin, 20, 12);
  EXPECT_NEAR(result.holds[0].end, 80, 12);
  const RetargetFigures figures = MeasureRetargeting(result, robot, body);
  EXPECT_LT(figures.holds.at(0).most, 0.006);
  EXPECT_EQ(figures.slide, 0);
  EXPECT_EQ(figures.position_breaks + figures.velocity_breaks, 0);
  // By its directions alone the hand is elsewhere.
  Retargeted heedless = RetargetMotion(person, motion, robot, body);
  heedless.objects = result.objects;
  heedless.holds = result.holds;
  const RetargetFigures off = MeasureRetargeting(heedless, robot, body);
  EXPECT_GT(off.holds.at(0).mean, 0.02);
  const auto reasons = [](const RetargetFigures& of) {
    return ::testing::PrintToString(JudgeRetargeting(of, nullptr).reasons);
  };
  EXPECT_THAT(reasons(off), ::testing::ContainsRegex("the left hand is [0-9]+ mm off cup"));
  EXPECT_THAT(reasons(figures), ::testing::Not(::testing::HasSubstr("cup")));
  for (const TrackedObject& object : result.objects) {
    EXPECT_NEAR(object.X_WO[0].translation().x(),
                result.scale * objects[&object - result.objects.data()].X_WO[0].translation().x(),
                1e-12);
  }
  testing::BipedShape stands;
  stands.has_legs = false;
  const Robot fixed = MakeBiped(stands);
  EXPECT_THROW(RetargetMotion(person, motion, fixed, FindRobotBody(fixed, {}, {}), objects), Error);
}

TEST(HeldObjectsTest, ANearHandThatPassesOrAThingThatRestsIsNoHold) {
  const KinematicModel person = Person(1.75);
  const PoseTrajectory motion = Squat(person);
  const HumanMotion human = MoveHuman(person, FindHumanBody(person), motion);
  // It rests where the hand begins; the hand goes away, and comes back.
  auto objects = CupOnTable(person, motion, 0, 1);
  EXPECT_TRUE(FindHolds(human, objects).empty());
  // It is not known while it is taken along.
  objects = CupOnTable(person, motion, 20, 80);
  objects[0].end = 10;
  EXPECT_TRUE(FindHolds(human, objects).empty());
  const std::vector<double> weights = WeightsOfHold({{0, 1, 40, 60}}, 1, 100, 100);
  EXPECT_EQ(weights[10], 0);
  EXPECT_EQ(weights[40], 1);
  EXPECT_EQ(weights[59], 1);
  EXPECT_NEAR(weights[30], weights[69], 1e-12);
  EXPECT_EQ(WeightsOfHold({{0, 1, 40, 60}}, 0, 100, 100)[50], 0);
}

TEST(RetargetTest, ASoleInAnotherUnitIsQuestioned) {
  const Robot robot = MakeBiped({});
  for (const double height : {50.0, 0.00005, -0.05}) {
    try {
      FindRobotBody(robot, {}, {height});
      FAIL() << height;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("5 to 500 mm"));
    }
  }
  EXPECT_NO_THROW(FindRobotBody(robot, {}, {0.0}));
}

TEST(FollowWatchTest, CountsAsTheFiguresOfAWholeMotionDo) {
  const KinematicModel person = Person(1.75);
  testing::BipedShape shape;
  shape.hip_velocity = 1.2;
  const Robot robot = MakeBiped(shape);
  const RobotBody body = FindRobotBody(robot, {}, {});
  const PoseTrajectory motion = Squat(person);
  const RetargetFigures all =
      MeasureRetargeting(FollowMotion(person, motion, robot, body), robot, body);
  GuardedFollower follower(std::make_shared<KinematicModel>(person), robot, body, motion.rate, {});
  FollowWatch watch(robot, body);
  for (int k = 0; k < motion.num_frames(); ++k) {
    const Posture posture = follower.Follow(ModelPosture(person, motion, k), motion.time(k));
    watch.Take(follower, posture, motion.time(k));
  }
  const RetargetFigures counted = watch.Figures();
  EXPECT_EQ(counted.num_frames, 200);
  EXPECT_EQ(counted.slide, all.slide);
  EXPECT_EQ(counted.position_breaks + counted.velocity_breaks, 0);
  EXPECT_NEAR(counted.direction, all.direction, 1e-9);
  EXPECT_NEAR(counted.penetration, all.penetration, 1e-9);
  ASSERT_EQ(counted.joints.size(), all.joints.size());
  ASSERT_FALSE(counted.joints.empty());  // the hips at their velocities
  for (std::size_t i = 0; i < all.joints.size(); ++i) {
    EXPECT_EQ(counted.joints[i].name, all.joints[i].name);
    EXPECT_NEAR(counted.joints[i].share_at_speed, all.joints[i].share_at_speed, 1e-9);
  }
  // A foot that is pushed along slides.
  FollowWatch pushed(robot, body);
  Posture posture = follower.Follow(ModelPosture(person, motion, 0), 10);
  std::vector<Eigen::Isometry3d> X_WS = follower.X_WS();
  for (int k = 0; k < 11; ++k) {
    for (Eigen::Isometry3d& X : X_WS) X.translation().x() += 0.001;
    pushed.Take({follower.person(), posture, X_WS, {true, true}, FollowState::kTracks, 0.01 * k});
  }
  EXPECT_EQ(pushed.Figures().slide, 1);
}

}  // namespace
}  // namespace mmm_converter
