// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "common/io/mmm/mmm_motion.h"
#include "common/io/robot/robot_file.h"
#include "common/motion/marker_synthesis.h"
#include "common/pipeline/retarget_verdict.h"
#include "common/retarget/belt.h"
#include "common/retarget/follow_figures.h"
#include "common/retarget/guarded_follower.h"
#include "tests/common/retarget/biped.h"
#include "tests/common/retarget/squat.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using testing::MakeBiped;
using testing::Person;
using testing::SharedData;
using testing::Squat;

constexpr double kOneDegree = std::numbers::pi / 180, kFrame = 0.01;

/// The largest of what a robot did from frame to frame, and its rms.
class MotionMeter {
 public:
  void Take(const Posture& posture, double dt) {
    if (frames_ > 0) {
      const Eigen::VectorXd speed = (posture.joint_angles - last_.joint_angles) / dt;
      most_speed = std::max(most_speed, speed.cwiseAbs().maxCoeff());
      root_speed = std::max(root_speed, (posture.position - last_.position).norm() / dt);
      if (frames_ > 1) {
        const Eigen::VectorXd rise = (speed - speed_) / dt;
        most_rise = std::max(most_rise, rise.cwiseAbs().maxCoeff());
        sum_ += rise.squaredNorm() / static_cast<double>(rise.size());
      }
      speed_ = speed;
    }
    last_ = posture;
    ++frames_;
  }
  double rms() const { return std::sqrt(sum_ / std::max(1, frames_ - 2)); }

  double most_speed = 0, most_rise = 0, root_speed = 0;

 private:
  Posture last_;
  Eigen::VectorXd speed_;
  double sum_ = 0;
  int frames_ = 0;
};

TEST(MotionGovernorTest, WhatIsWithinLimitsIsDoneExactly) {
  const Robot robot = MakeBiped({});
  MotionGovernor governor(LimitsOf(robot, {}));
  Posture posture = ZeroPosture(robot.model);
  const int knee = robot.model.FindJoint("left_knee");
  governor.Start(posture);
  for (int k = 1; k < 200; ++k) {
    const double t = k * kFrame;
    posture.joint_angles[knee] = 1 - std::cos(4 * t);
    posture.position.x() = 1 - std::cos(2 * t);
    posture.orientation = Eigen::AngleAxisd(1 - std::cos(3 * t), Eigen::Vector3d::UnitZ());
    governor.Go(posture, kFrame);
    EXPECT_LT(Local(posture, governor.posture()).cwiseAbs().maxCoeff(), 1e-9) << k;
  }
}

TEST(MotionGovernorTest, AStepIsGoneWithinLimitsAndNotBeyondItsEnd) {
  testing::BipedShape shape;
  shape.hip_velocity = 3;
  const Robot robot = MakeBiped(shape);
  const MotionLimits limits = LimitsOf(robot, {});
  for (const double dt : {0.002, 0.01, 0.1}) {
    MotionGovernor governor(limits);
    MotionMeter meter;
    Posture posture = ZeroPosture(robot.model);
    governor.Start(posture);
    meter.Take(posture, dt);
    posture.joint_angles.setConstant(1);
    posture.joint_angles = posture.joint_angles.cwiseMin(limits.upper).cwiseMax(limits.lower);
    posture.position = {0, 2, 0};
    const Eigen::VectorXd way = Local(governor.posture(), posture);
    for (double t = 0; t < 1.5; t += dt) {
      governor.Go(posture, dt);
      meter.Take(governor.posture(), dt);
      const Eigen::VectorXd left = Local(governor.posture(), posture);
      EXPECT_GE(left.cwiseProduct(way.cwiseSign()).minCoeff(), -1e-9) << t;
    }
    EXPECT_LT(Local(governor.posture(), posture).cwiseAbs().maxCoeff(), 1e-6) << dt;
    EXPECT_LE(meter.most_rise, limits.acceleration.tail(3).maxCoeff() * (1 + 1e-6));
    EXPECT_LE(meter.most_speed, limits.speed.tail(limits.lower.size()).maxCoeff());
    EXPECT_LE(meter.root_speed, 6);
  }
}

TEST(MotionGovernorTest, NoTargetMakesItBreakALimit) {
  const Robot robot = MakeBiped({});
  FollowOptions options;
  options.joint_speed = 4;
  options.joint_acceleration = 60;
  options.root_speed = 1.5;
  const MotionLimits limits = LimitsOf(robot, options);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-3, 3);
  MotionGovernor governor(limits);
  governor.Start(ZeroPosture(robot.model));
  MotionMeter meter;
  for (int k = 0; k < 4000; ++k) {
    Posture target = ZeroPosture(robot.model);
    if (random() % 20 == 0) governor.Blend(target, 0.1, 0.5);
    for (double& angle : target.joint_angles) angle = any(random);
    target.joint_angles = target.joint_angles.cwiseMin(limits.upper).cwiseMax(limits.lower);
    target.position = Eigen::Vector3d(any(random), any(random), any(random));
    target.orientation = Eigen::Quaterniond(any(random), any(random), any(random), any(random));
    target.orientation.normalize();
    random() % 9 == 0 ? governor.Brake(kFrame) : governor.Go(target, kFrame);
    const Posture& now = governor.posture();
    meter.Take(now, kFrame);
    ASSERT_GE((now.joint_angles - limits.lower).minCoeff(), 0);
    ASSERT_GE((limits.upper - now.joint_angles).minCoeff(), 0);
  }
  EXPECT_LE(meter.most_speed, 4);
  EXPECT_LE(meter.most_rise, 60 * (1 + 1e-6));
  EXPECT_LE(meter.root_speed, 1.5);
}

/// A person who squats, over and over, on a robot.
class Following {
 public:
  explicit Following(const Robot& robot, const FollowOptions& options = {})
      : robot_(robot),
        body_(FindRobotBody(robot, {}, {})),
        person_(Person(1.75)),
        motion_(Squat(person_)),
        follower_(std::make_shared<KinematicModel>(person_), robot_, body_, 100, options),
        watch_(robot_, body_) {}

  Posture PersonAt(int k) const { return ModelPosture(person_, motion_, k % 200); }
  const Posture& Follow(int k) { return Follow(k, PersonAt(k)); }
  const Posture& Follow(int k, const Posture& person) {
    return Take(k, follower_.Follow(person, k * kFrame));
  }
  const Posture& Hold(int k) { return Take(k, follower_.Hold(k * kFrame)); }

  const GuardedFollower& follower() const { return follower_; }
  RetargetFigures Figures() const { return watch_.Figures(); }
  double Lowest() const {
    double lowest = INFINITY;
    for (const RobotFoot& foot : *body_.feet) {
      lowest = std::min(lowest, LowestOf(foot, follower_.X_WS()[foot.segment]));
    }
    return lowest;
  }

  MotionMeter meter;

 private:
  const Posture& Take(int k, const Posture& posture) {
    meter.Take(posture, kFrame);
    watch_.Take(follower_, posture, k * kFrame);
    return posture;
  }

  const Robot& robot_;
  RobotBody body_;
  KinematicModel person_;
  PoseTrajectory motion_;
  GuardedFollower follower_;
  FollowWatch watch_;
};

double Degrees(const Posture& a, const Posture& b) {
  return (a.joint_angles - b.joint_angles).cwiseAbs().maxCoeff() / kOneDegree;
}

TEST(GuardedFollowerTest, ASecondAfterAnyGapTheRobotIsWhereItWouldBe) {
  const Robot robot = MakeBiped({});
  for (const int begin : {30, 110}) {
    for (const int length : {3, 10, 30, 100, 500}) {
      if (begin == 30 && length == 500) continue;
      SCOPED_TRACE(std::to_string(begin) + " " + std::to_string(length));
      Following seen(robot), lost(robot);
      const int end = begin + length, last = end + 100;
      for (int k = 0; k < last; ++k) {
        seen.Follow(k);
        k < begin || k >= end ? lost.Follow(k) : lost.Hold(k);
        EXPECT_EQ(lost.follower().state() == FollowState::kHolds, k >= begin && k < end);
      }
      EXPECT_EQ(lost.follower().state(), FollowState::kTracks);
      EXPECT_LT(Degrees(seen.Follow(last), lost.Follow(last)), 3);
      EXPECT_LT(lost.meter.rms(), 60);
      EXPECT_LT(lost.meter.root_speed, 6);
      const RetargetFigures figures = lost.Figures();
      EXPECT_EQ(figures.followed.holds, 1);
      EXPECT_EQ(figures.followed.returns, 1);
      EXPECT_EQ(figures.followed.jumps, 0);
      EXPECT_NEAR(figures.followed.held, length * kFrame, 1e-6);
      EXPECT_LT(figures.penetration, 1e-3);
      EXPECT_THAT(::testing::PrintToString(JudgeRetargeting(figures, nullptr).reasons),
                  ::testing::HasSubstr("the person was lost 1 time: the robot held for"));
    }
  }
}

TEST(GuardedFollowerTest, ASwingInTheFirstFrameIsNoStance) {
  const Robot robot = MakeBiped({});
  Following stands(robot), glides(robot);
  const Posture person = stands.PersonAt(0);
  for (int k = 0; k < 20; ++k) {
    Posture gliding = person;
    gliding.position.x() += 1.5 * k * kFrame;
    const Posture& there = stands.Follow(k, person);
    const Posture& gone = glides.Follow(k, gliding);
    EXPECT_FALSE(glides.follower().stands(0) || glides.follower().stands(1)) << k;
    if (k < 10) continue;
    EXPECT_LT(Degrees(there, gone), 3) << k;
  }
}

TEST(GuardedFollowerTest, FeetStandWhileJointsAreLate) {
  const Robot robot = MakeBiped({});
  FollowOptions late;
  late.joint_acceleration = 16;
  Following following(robot, late), in_time(robot);
  double most = 0;
  for (int k = 0; k < 400; ++k)
    most = std::max(most, Degrees(following.Follow(k), in_time.Follow(k)));
  EXPECT_GT(most, 5);
  EXPECT_LT(following.Figures().slide, 0.01);
  EXPECT_LE(following.meter.most_rise, 16 * (1 + 1e-6));
}

TEST(GuardedFollowerTest, FeetTurnWithWhomTurnsOnTheSpot) {
  const Robot robot = MakeBiped({});
  Following following(robot);
  const Posture person = following.PersonAt(0);
  Posture first, last;
  for (int k = 0; k < 400; ++k) {
    Posture turned = person;
    const double angle = std::clamp((k - 50) / 200.0, 0.0, 1.0) * std::numbers::pi;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    turned.position = turn * person.position;
    turned.orientation = turn * person.orientation;
    last = following.Follow(k, turned);
    EXPECT_TRUE(k < 10 || following.follower().stands(0)) << k;
    if (k == 50) first = last;
  }
  // Feet stay behind by what they may.
  EXPECT_LT(Degrees(first, last), 40);
  const Eigen::AngleAxisd between(first.orientation.conjugate() * last.orientation);
  EXPECT_NEAR(between.angle(), std::numbers::pi, 0.1);
}

TEST(PointWatchTest, ALevelIsLearntWhereAFootStands) {
  PointWatch heel(0.02);
  for (int k = 0; k < 100; ++k) {
    heel.Take(Eigen::Vector3d(0, 0, 0.07), k * kFrame);
    EXPECT_TRUE(k < 20 || heel.is_on()) << k;
  }
  EXPECT_NEAR(heel.level(), 0.07, 5e-3);
}

TEST(GuardedFollowerTest, ALostPersonsRobotStopsAndThenRests) {
  const Robot robot = MakeBiped({});
  FollowOptions options;
  options.rest_after = 1;
  Following lost(robot, options);
  int k = 0;
  for (; k < 50; ++k) lost.Follow(k);
  for (; k < 100; ++k) lost.Hold(k);
  const Posture held = lost.Hold(k++);
  EXPECT_EQ(Degrees(held, lost.Hold(k++)), 0);
  EXPECT_GT(Degrees(held, ZeroPosture(robot.model)), 10);
  EXPECT_FALSE(lost.follower().rests());
  for (; k < 500; ++k) lost.Hold(k);
  EXPECT_TRUE(lost.follower().rests());
  EXPECT_LT(Degrees(lost.Hold(k), ZeroPosture(robot.model)), 1e-6);
  EXPECT_NEAR(lost.Lowest(), 0, 1e-3);
  EXPECT_LT(lost.meter.rms(), 60);
}

TEST(GuardedFollowerTest, AJumpIsReachedWithinLimitsAndTold) {
  const Robot robot = MakeBiped({});
  Following seen(robot), jumps(robot);
  for (int k = 0; k < 250; ++k) {
    seen.Follow(k);
    Posture person = seen.PersonAt(k);
    // What a filter makes of a person whom nobody sees.
    if (k >= 60 && k < 90) {
      person.position += Eigen::Vector3d(0.1 * (k - 60), 0.3, 0.2);
      person.orientation =
          Eigen::AngleAxisd(0.15 * (k - 60), Eigen::Vector3d(1, 2, 3).normalized());
    }
    jumps.Follow(k, person);
  }
  EXPECT_LT(Degrees(seen.Follow(250), jumps.Follow(250)), 3);
  EXPECT_LT(jumps.meter.root_speed, 6);
  EXPECT_LT(jumps.meter.rms(), 60);
  EXPECT_GE(jumps.Figures().followed.jumps, 1);
  EXPECT_EQ(seen.Figures().followed.jumps, 0);
  EXPECT_THAT(::testing::PrintToString(JudgeRetargeting(jumps.Figures(), nullptr).reasons),
              ::testing::HasSubstr("jumped"));
}

TEST(GuardedFollowerTest, WhatIsNoNumberIsHeldThrough) {
  const Robot robot = MakeBiped({});
  Following following(robot);
  for (int k = 0; k < 60; ++k) {
    Posture person = following.PersonAt(k);
    if (k < 3 || (k > 20 && k < 25)) person.position.x() = NAN;
    if (k == 30) person.joint_angles.setConstant(INFINITY);
    if (k == 40) person.position.x() = 1e300;
    const Posture& posture = following.Follow(k, person);
    ASSERT_TRUE(posture.joint_angles.allFinite() && posture.position.allFinite()) << k;
  }
  EXPECT_EQ(following.follower().state(), FollowState::kReturns);
}

TEST(GuardedFollowerTest, TheFloorIsWhereThePersonStands) {
  const Robot robot = MakeBiped({});
  for (const double floor : {-0.3, -0.05, 0.0, 0.05, 0.12, 0.8}) {
    Following following(robot);
    for (int k = 0; k < 100; ++k) {
      Posture person = following.PersonAt(k);
      person.position.z() += floor;
      following.Follow(k, person);
      if (k <= 50) continue;
      EXPECT_NEAR(following.Lowest(), 0, 2e-3) << floor << " " << k;
    }
  }
}

/// Walks at 1.1 m/s along x: each foot lies flat for 0.6 s, then swings for 0.4 s.
HumanMotion Walker() {
  constexpr double kSpeed = 1.1;
  HumanMotion motion;
  motion.rate = 100;
  motion.bodies.resize(300);
  for (std::size_t i = 0; i < 2; ++i) {
    motion.heels[i].resize(3, 300);
    for (int k = 0; k < 300; ++k) {
      const int shifted = i == 0 ? k : k + 50, within = shifted % 100, steps = shifted / 100;
      const double part = std::max(0, within - 60) / 40.0;
      const double lifted = 0.1 * std::sin(std::numbers::pi * part);
      motion.heels[i].col(k) << kSpeed * (steps + part), 0.2 * i, 0.05 + lifted;
      motion.bodies[k].mid_hip = {kSpeed * k / 100, 0.1, 0.9};
    }
    motion.toes[i] = motion.heels[i];
    motion.toes[i].row(0).array() += 0.2;
  }
  return motion;
}

/// The belt under a walker's feet.
Eigen::Vector3d BeltOf(const HumanMotion& walker) {
  FootMotion motion;
  motion.rate = walker.rate;
  motion.body.resize(3, walker.num_frames());
  for (int k = 0; k < walker.num_frames(); ++k) motion.body.col(k) = walker.bodies[k].mid_hip;
  for (std::size_t i = 0; i < 2; ++i) {
    motion.feet[i].heel = walker.heels[i];
    motion.feet[i].toe = walker.toes[i];
  }
  FindSpeeds(&motion);
  return (motion.feet[0].belt + motion.feet[1].belt) / 2;
}

TEST(BeltTest, ABeltIsWhatFeetLieOnOfWhomGoesNowhere) {
  HumanMotion walker = Walker();
  EXPECT_TRUE(BeltOf(walker).isZero());
  const Eigen::Matrix3Xd heel = walker.heels[0];
  MoveAgainst({1.1, 0, 0}, &walker);
  EXPECT_LT((BeltOf(walker) - Eigen::Vector3d(-1.1, 0, 0)).norm(), 1e-6);
  MoveAgainst(BeltOf(walker), &walker);
  EXPECT_LT((walker.heels[0] - heel).norm(), 1e-6);
}

TEST(BeltTest, FrameByFrameABeltIsFoundAndLost) {
  HumanMotion walker = Walker();
  MoveAgainst({1.1, 0, 0}, &walker);
  BeltWatch watch;
  std::array<std::array<PointWatch, 2>, 2> feet = {
      {{PointWatch(0.05), PointWatch(0.05)}, {PointWatch(0.05), PointWatch(0.05)}}};
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  const auto take = [&](int k, const Eigen::Vector3d& stands) {
    way += kFrame * watch.velocity();
    for (std::size_t i = 0; i < 2; ++i) {
      feet[i][0].Take(walker.heels[i].col(k % 300) + stands - way, k * kFrame);
      feet[i][1].Take(walker.toes[i].col(k % 300) + stands - way, k * kFrame);
    }
    watch.Take(feet, Eigen::Vector3d(0, 0.1, 0.9) + stands - way, kFrame);
  };
  int k = 0;
  for (; k < 200; ++k) take(k, Eigen::Vector3d::Zero());
  EXPECT_NEAR(watch.velocity().x(), -1.1, 0.05);
  EXPECT_TRUE(feet[0][0].is_on() || feet[1][0].is_on());
  // The belt stands, and so does the person.
  for (std::size_t i = 0; i < 2; ++i) {
    walker.heels[i] = walker.heels[i].col(0).replicate(1, 300).eval();
    walker.toes[i] = walker.toes[i].col(0).replicate(1, 300).eval();
  }
  for (; k < 400; ++k) take(k, Eigen::Vector3d::Zero());
  EXPECT_LT(watch.velocity().norm(), 0.05);
}

struct RealGap {
  const char *robot, *motion;
};

class RealGapTest : public ::testing::TestWithParam<RealGap> {};

TEST_P(RealGapTest, ASecondAfterAGapTheRobotIsWhereItWouldBe) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const MmmMotionFile file = ReadMmmMotionFile(SharedData(GetParam().motion));
  const PoseTrajectory& motion = file.motions.front().trajectory;
  const Robot robot = ReadRobotFile(SharedData(GetParam().robot));
  const RobotBody body = FindRobotBody(robot, {}, {});
  const auto person = std::make_shared<KinematicModel>(Person(1.8));
  for (const auto& [begin, length] : {std::pair(60, 30), {40, 10}, {110, 100}}) {
    GuardedFollower seen(person, robot, body, 100, {}), lost(person, robot, body, 100, {});
    MotionMeter meter;
    const int last = begin + length + 100;
    for (int k = 0; k <= last; ++k) {
      const Posture posture = ModelPosture(*person, motion, k);
      const Posture& a = seen.Follow(posture, k * kFrame);
      const bool is_seen = k < begin || k >= begin + length;
      const Posture& b = is_seen ? lost.Follow(posture, k * kFrame) : lost.Hold(k * kFrame);
      meter.Take(b, kFrame);
      if (k < last) continue;
      EXPECT_LT((a.joint_angles - b.joint_angles).norm() /
                    std::sqrt(static_cast<double>(a.joint_angles.size())),
                3 * kOneDegree)
          << begin << " " << length;
    }
    EXPECT_LT(meter.rms(), 60);
    EXPECT_LT(meter.root_speed, 6);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Robots, RealGapTest,
    ::testing::Values(
        RealGap{"robots/unitree_g1/g1_custom_collision_29dof.urdf",
                "mmm/motions_legacy/walking_medium01_motion395.xml"},
        RealGap{"robots/unitree_h1/h1.urdf", "mmm/motions_legacy/walking_medium01_motion395.xml"},
        RealGap{"robots/booster_t1/T1_23dof.urdf", "mmm/motions_mmm2/wave_left01.xml"}));

}  // namespace
}  // namespace mmm_converter
