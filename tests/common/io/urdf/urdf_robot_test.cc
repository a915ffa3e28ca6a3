// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/robot/robot_file.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::SharedData;

TEST(UrdfRobot, HasShapesVelocitiesAndLinks) {
  Warnings warnings;
  const Robot robot = ParseUrdfRobot(
      "<robot name='r'><link name='a'/><link name='b'>"
      "<collision><origin xyz='1 2 3' rpy='1.5707963267948966 0 1.5707963267948966'/>"
      "<geometry><cylinder radius='0.1' length='0.6'/></geometry></collision>"
      "<collision><geometry><box size='2 4 6'/></geometry></collision>"
      "<collision><geometry><mesh filename='m'/></geometry></collision>"
      "<collision><geometry><sphere radius='-1'/></geometry></collision>"
      "<visual><geometry><sphere radius='9'/></geometry></visual></link>"
      "<link name='c'/><link name='L_marker'/>"
      "<joint name='k' type='revolute'><parent link='a'/><child link='b'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='6'/></joint>"
      "<joint name='j' type='continuous'><parent link='a'/><child link='c'/>"
      "<limit effort='1' velocity='0'/></joint>"
      "<joint name='m' type='fixed'><parent link='b'/><child link='L_marker'/>"
      "<origin xyz='0 0 1'/></joint></robot>",
      "r.urdf", &warnings);
  ASSERT_EQ(robot.shapes.size(), 2u);
  EXPECT_EQ(robot.shapes[0].kind, ContactShape::Kind::kCylinder);
  EXPECT_EQ(robot.shapes[0].segment, 1);
  EXPECT_EQ(robot.shapes[0].half_length, 0.3);
  // Rz(90) Rx(90): the axis points along x.
  EXPECT_TRUE(robot.shapes[0].X_SG.linear().col(2).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
  EXPECT_EQ(robot.shapes[0].X_SG.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(robot.shapes[1].half, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(robot.meshes.size(), 1u);
  EXPECT_EQ(robot.meshes[0].segment, 1);
  EXPECT_EQ(robot.meshes[0].file, "m");
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("link 'b': a <collision> is not a box")));
  ASSERT_EQ(robot.velocity_limits.size(), 2);
  EXPECT_EQ(robot.velocity_limits[0], 6);
  EXPECT_TRUE(std::isinf(robot.velocity_limits[1]));
  std::vector<std::string> links;
  for (const Robot::Link& link : robot.links) links.push_back(link.name);
  EXPECT_THAT(links, ElementsAre("a", "b", "L_marker", "c"));
  EXPECT_EQ(robot.links[2].segment, 1);
  EXPECT_EQ(robot.links[2].parent, 1);
  EXPECT_EQ(robot.links[2].X_SL.translation().z(), 1);
}

TEST(UrdfRobot, FollowersMakeTheirLeaderSlower) {
  const Robot robot = ParseUrdfRobot(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='k' type='revolute'><parent link='a'/><child link='b'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='6'/></joint>"
      "<joint name='j' type='revolute'><parent link='a'/><child link='c'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='4'/><mimic joint='k' multiplier='-2'/>"
      "</joint></robot>",
      "r.urdf");
  EXPECT_THAT(robot.velocity_limits, ElementsAre(2));
}

// What design notes of these robots measured.
TEST(UrdfRobotReal, SolesAreWhereTheyWereMeasured) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  struct Case {
    const char* file;
    const char* joint;
    int joints;
    double depth;
    const char* said;
  };
  for (const Case& one :
       {Case{"unitree_g1/g1_custom_collision_29dof.urdf", "left_ankle_roll_joint", 29, 0.04,
             "2 cylinders of left_ankle_roll_link"},
        Case{"unitree_h1/h1.urdf", "right_ankle_joint", 19, 0.062, "1 box of right_ankle_link"}}) {
    const Robot robot = ReadRobotFile(SharedData(std::string("robots/") + one.file));
    EXPECT_EQ(robot.model.num_joints(), one.joints);
    EXPECT_FALSE(robot.model.is_root_fixed());
    EXPECT_TRUE((robot.velocity_limits.array() < 100).all());
    const auto sole = FindSole(robot, robot.model.FindSegment(one.joint), {}, nullptr);
    ASSERT_TRUE(sole) << one.file;
    EXPECT_NEAR(sole->depth, one.depth, 1e-3) << one.file;  // the notes' mm
    EXPECT_EQ(sole->said, one.said);
  }
}

}  // namespace
}  // namespace mmm_converter
