// SPDX-License-Identifier: MIT
#include "common/model/robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;

constexpr double kRobotRounding = 1e-14;  // sums of a few numbers of order 1

ContactShape ShapeOf(ContactShape::Kind kind) {
  ContactShape shape;
  shape.kind = kind;
  shape.half = {0.1, 0.2, 0.3};
  shape.radius = 0.05;
  shape.half_length = 0.4;
  shape.X_SG.translation() = Eigen::Vector3d(1, 2, 3);
  return shape;
}

TEST(ContactShape, LowestPointsAreExact) {
  using Kind = ContactShape::Kind;
  const double s = std::sqrt(0.5);
  Eigen::Isometry3d X_WS(Eigen::AngleAxisd(EIGEN_PI / 4, Eigen::Vector3d::UnitX()));
  const double z = s * (2 + 3);  // of the shape's centre
  const auto lowest = [&](Kind kind) { return LowestHeight(ShapeOf(kind), X_WS); };
  EXPECT_NEAR(lowest(Kind::kBox), z - s * (0.2 + 0.3), kRobotRounding);
  EXPECT_NEAR(lowest(Kind::kSphere), z - 0.05, kRobotRounding);
  EXPECT_NEAR(lowest(Kind::kCapsule), z - s * 0.4 - 0.05, kRobotRounding);
  EXPECT_NEAR(lowest(Kind::kCylinder), z - s * 0.4 - s * 0.05, kRobotRounding);
  EXPECT_NEAR(lowest(Kind::kEllipsoid), z - s * std::hypot(0.2, 0.3), kRobotRounding);
}

TEST(ContactShape, AFaceIsMetInItsMiddle) {
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  EXPECT_EQ(SupportPoint(ShapeOf(ContactShape::Kind::kBox), down), Eigen::Vector3d(1, 2, 2.7));
  EXPECT_EQ(SupportPoint(ShapeOf(ContactShape::Kind::kCylinder), down), Eigen::Vector3d(1, 2, 2.6));
}

TEST(ContactShape, NoPointOfTheSurfaceIsFarther) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  for (int kind = 0; kind < 5; ++kind) {
    ContactShape shape = ShapeOf(static_cast<ContactShape::Kind>(kind));
    shape.X_SG.rotate(Eigen::AngleAxisd(normal(random), direction()));
    for (int run = 0; run < 100; ++run) {
      const Eigen::Vector3d d = direction();
      const double farthest = d.dot(SupportPoint(shape, d));
      EXPECT_GE(farthest + kRobotRounding, d.dot(SupportPoint(shape, direction()))) << kind;
    }
  }
}

/// A leg of one joint, whose foot is a body fixed below it.
Robot Leg() {
  ModelDescription description;
  description.name = "r";
  description.segments.resize(3);
  description.segments[0].name = "base";
  Segment& ankle = description.segments[1];
  ankle.name = "ankle";
  ankle.parent = 0;
  ankle.type = JointType::kRevolute;
  ankle.axis = Eigen::Vector3d::UnitY();
  ankle.X_PF = Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitY());  // x of S is down
  ankle.lower = -1;
  ankle.upper = 1;
  Segment& toe = description.segments[2];
  toe.name = "toe";
  toe.parent = 1;
  toe.X_PF.translation() = Eigen::Vector3d(0.04, 0, 0.1);
  return {KinematicModel(std::move(description)),
          {{"pelvis", 0, {}, -1}, {"foot", 1, {}, 0}},
          {},
          {},
          {},
          Eigen::VectorXd::Constant(1, 3),
          "URDF"};
}

TEST(Sole, IsOfTheShapesOfTheRigidBody) {
  Robot robot = Leg();
  std::string reason;
  EXPECT_FALSE(FindSole(robot, 2, {}, &reason));
  EXPECT_EQ(reason, "foot has no shape that touches the ground");
  robot.meshes = {{"a.stl", 1}, {"b.stl", 2}};
  EXPECT_FALSE(FindSole(robot, 2, {}, &reason));
  EXPECT_THAT(reason, HasSubstr("foot has 2 meshes, which are not read"));
  robot.sites = {{"left_SOLE", 2, Eigen::Isometry3d::Identity()}};
  auto sole = FindSole(robot, 1, {}, nullptr);
  ASSERT_TRUE(sole);
  EXPECT_EQ(sole->source, Sole::Source::kNamed);
  EXPECT_EQ(sole->said, "site left_SOLE");
  EXPECT_NEAR(sole->depth, 0.04, kRobotRounding);
  ContactShape ball;
  ball.segment = 2;
  ball.radius = 0.01;
  robot.shapes = {ball, ball};
  sole = FindSole(robot, 2, {}, nullptr);
  ASSERT_TRUE(sole);
  EXPECT_EQ(sole->source, Sole::Source::kShapes);
  EXPECT_EQ(sole->said, "2 spheres of foot");
  EXPECT_EQ(sole->segment, 1);
  EXPECT_NEAR(sole->depth, 0.05, kRobotRounding);
  EXPECT_TRUE(sole->down_S.isApprox(Eigen::Vector3d::UnitX(), kRobotRounding));
  EXPECT_TRUE(sole->shapes[0].X_SG.translation().isApprox(Eigen::Vector3d(0.04, 0, 0.1)));
  sole = FindSole(robot, 2, {0.07}, nullptr);
  ASSERT_TRUE(sole);
  EXPECT_EQ(sole->source, Sole::Source::kGiven);
  EXPECT_NEAR(sole->depth, 0.07, kRobotRounding);
}

}  // namespace
}  // namespace mmm_converter
