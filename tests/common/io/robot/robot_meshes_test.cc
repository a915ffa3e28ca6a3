// SPDX-License-Identifier: MIT
#include "common/io/robot/robot_meshes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/io/mesh/mesh_paths.h"
#include "common/io/robot/robot_file.h"
#include "common/support/opened_files.h"
#include "tests/support/box_mesh.h"
#include "tests/support/scoped_environment.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::BoxMesh;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TestFolder;

const BoxMesh kFoot = {{-0.06, -0.04, -0.08}, {0.14, 0.04, 0.01}};

std::string Put(const std::string& name, const std::string& content) {
  const fs::path path = fs::path(TestFolder()) / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << content;
  return path.string();
}

/// A foot below an ankle, with this in its link.
std::string UrdfOfFoot(const std::string& content) {
  return "<robot name='r'><link name='a'/><link name='foot'>" + content +
         "</link><joint name='ankle' type='revolute'><parent link='a'/><child link='foot'/>"
         "<axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";
}

std::string MeshIn(const std::string& kind, const std::string& file, const std::string& more = "") {
  return "<" + kind + "><geometry><mesh filename='" + file + "' " + more + "/></geometry></" +
         kind + ">";
}

std::optional<Sole> SoleOf(const std::string& file, Warnings* warnings, SoleChoice choice = {}) {
  Robot robot = ReadRobotFile(file, warnings);
  const int ankle = robot.model.FindSegment("ankle");
  ReadMeshes(ankle, &robot, warnings);
  return FindSole(robot, ankle, choice, nullptr);
}

TEST(RobotMeshes, UrdfAndMjcfHaveOneSole) {
  Put("meshes/foot.STL", kFoot.BinaryStl());
  const std::string mjcf = Put("mjcf/r.xml", R"(<mujoco><compiler meshdir="../meshes"/>
<default><mesh scale="1 1 1"/></default><asset><mesh file="foot.STL"/></asset>
<worldbody><body name="a"><freejoint/><geom size="0.1"/><body name="foot">
<joint name="ankle" axis="0 1 0"/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
<geom type="mesh" mesh="foot" contype="0" conaffinity="0"/></body></body></worldbody></mujoco>)");
  const std::string urdf =
      Put("urdf/r.urdf", UrdfOfFoot(MeshIn("collision", "../meshes/foot.STL")));
  for (const std::string& file : {mjcf, urdf}) {
    Warnings warnings;
    const OpenedFiles opened;
    const auto sole = SoleOf(file, &warnings);
    ASSERT_TRUE(sole) << file;
    EXPECT_EQ(sole->source, Sole::Source::kMeshes);
    EXPECT_EQ(sole->said, "1 mesh of foot");
    EXPECT_NEAR(sole->depth, 0.08, 1e-7);
    EXPECT_EQ(sole->doubt, "");
    EXPECT_THAT(warnings.texts(), IsEmpty());
    EXPECT_EQ(opened.files().count(TestFolder() + "/meshes/foot.STL"), 1U);
  }
}

TEST(RobotMeshes, AreScaledPlacedAndOfCentimetres) {
  const BoxMesh centimetres = {{-6, -1, -4}, {14, 8, 4}};  // y is up
  Put("foot.dae", centimetres.Collada("Y_UP", 0.01));
  const std::string mass =
      "<inertial><origin xyz='{}'/><mass value='1'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
  const auto depth = [&](const std::string& content) {
    Warnings warnings;
    const auto sole = SoleOf(Put("r.urdf", UrdfOfFoot(content)), &warnings);
    EXPECT_THAT(warnings.texts(), IsEmpty());
    return sole ? sole->depth : -1;
  };
  EXPECT_NEAR(depth(MeshIn("visual", "foot.dae")), 0.01, 1e-7);
  EXPECT_NEAR(depth(MeshIn("visual", "file://" + TestFolder() + "/foot.dae", "scale='1 1 -2'")),
              0.16, 1e-7);
  EXPECT_NEAR(depth("<visual><origin xyz='0 0 -0.05' rpy='3.141592653589793 0 0'/><geometry><mesh "
                    "filename='foot.dae'/></geometry></visual>"),
              0.13, 1e-7);
  // Where the centre of mass tells that the mesh was never turned.
  EXPECT_NEAR(depth(fmt::format(fmt::runtime(mass), "0 0 0.03") + MeshIn("visual", "foot.dae")),
              0.01, 1e-7);
  EXPECT_NEAR(depth(fmt::format(fmt::runtime(mass), "0 0.03 0") + MeshIn("visual", "foot.dae")),
              0.04, 1e-7);
}

TEST(RobotMeshes, WhatTouchesIsBeforeWhatIsSeenAndShapesAreBeforeBoth) {
  Put("deep.stl", kFoot.AsciiStl());
  Put("flat.stl", BoxMesh{{-0.1, -0.1, -0.03}, {0.1, 0.1, 0}}.AsciiStl());
  const std::string both = MeshIn("visual", "deep.stl") + MeshIn("collision", "flat.stl");
  const std::string box =
      "<collision><origin xyz='0 0 -0.05'/><geometry><box size='0.1 0.1 0.04'/>"
      "</geometry></collision>";
  const auto sole = [&](const std::string& content, SoleChoice choice = {}) {
    Warnings warnings;
    return SoleOf(Put("r.urdf", UrdfOfFoot(content)), &warnings, choice).value_or(Sole{});
  };
  EXPECT_NEAR(sole(both).depth, 0.03, 1e-7);
  EXPECT_NEAR(sole(MeshIn("visual", "deep.stl") + MeshIn("collision", "none.stl")).depth, 0.08,
              1e-7);
  const Sole shapes = sole(box + MeshIn("visual", "deep.stl"));
  EXPECT_NEAR(shapes.depth, 0.07, 1e-12);
  EXPECT_THAT(shapes.doubt, HasSubstr("the sole is 1 box of foot, and 1 mesh of foot ends 10.0 mm "
                                      "lower"));
  EXPECT_EQ(sole(box + MeshIn("visual", "flat.stl")).doubt, "");
  SoleChoice choice;
  choice.take = SoleChoice::Take::kShapes;
  EXPECT_EQ(sole(box + MeshIn("visual", "deep.stl"), choice).doubt, "");
  choice.take = SoleChoice::Take::kMeshes;
  EXPECT_NEAR(sole(box + MeshIn("visual", "deep.stl"), choice).depth, 0.08, 1e-7);
  EXPECT_TRUE(sole(box, choice).shapes.empty());
}

TEST(RobotMeshes, ToesBelongToTheSole) {
  Put("foot.stl", kFoot.AsciiStl());
  Put("toe.stl", BoxMesh{{0, -0.04, -0.02}, {0.06, 0.04, 0}}.AsciiStl());
  std::string urdf = UrdfOfFoot(MeshIn("collision", "foot.stl"));
  urdf.replace(urdf.find("</robot>"), 8,
               "<link name='toe'>" + MeshIn("visual", "toe.stl") +
                   "</link><joint name='t' type='revolute'><origin xyz='0.14 0 -0.07'/><parent "
                   "link='foot'/><child link='toe'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' "
                   "effort='1' velocity='1'/></joint></robot>");
  Warnings warnings;
  const auto sole = SoleOf(Put("r.urdf", urdf), &warnings);
  ASSERT_TRUE(sole);
  EXPECT_EQ(sole->said, "2 meshes of foot");
  EXPECT_NEAR(sole->depth, 0.09, 1e-7);
  EXPECT_NEAR(SupportPoint(sole->shapes[1], Eigen::Vector3d::UnitX()).x(), 0.2, 1e-7);
}

TEST(RobotMeshes, WhatIsNotReadIsNamed) {
  Put("cut.stl", kFoot.BinaryStl().substr(0, 200));
  Put("large.stl", BoxMesh{{-60, -40, -80}, {140, 40, 10}}.BinaryStl());
  const auto warning = [](const std::string& file) {
    Warnings warnings;
    EXPECT_FALSE(SoleOf(Put("r.urdf", UrdfOfFoot(MeshIn("collision", file))), &warnings)) << file;
    EXPECT_EQ(warnings.texts().size(), 1U) << file;
    return warnings.texts().empty() ? "" : warnings.texts().front();
  };
  EXPECT_THAT(warning("package://other/foot.stl"),
              AllOf(HasSubstr("r.urdf: the mesh package://other/foot.stl of foot is not there"),
                    HasSubstr("ROS_PACKAGE_PATH")));
  EXPECT_THAT(warning("http://example.org/cut.stl"), HasSubstr("not fetched"));
  EXPECT_THAT(warning("cut.stl"), HasSubstr("can't be read: "));
  EXPECT_THAT(warning("large.stl"), HasSubstr("a scale"));
  EXPECT_THAT(warning("."), HasSubstr("is not there"));
}

TEST(MeshPaths, AreFoundAsRobotsFilesNameThem) {
  const std::string mesh = Put("robots/h1_description/meshes/a.stl", "a");
  const std::string robot = Put("robots/h1_description/urdf/x/r.urdf", "r");
  const std::string far = Put("ros/arm_description/m/b.stl", "b");
  const auto found = [&](const std::string& name) {
    const auto file = FindMeshFile(name, robot);
    return file ? (file->is_elsewhere ? "elsewhere " : "") + file->path : std::string();
  };
  EXPECT_EQ(found("package://h1_description/meshes/a.stl"), mesh);
  EXPECT_EQ(found("model://h1_description/meshes/a.stl"), mesh);
  EXPECT_EQ(found("../../meshes/a.stl"), mesh);
  EXPECT_EQ(found("file://" + mesh), mesh);
  EXPECT_EQ(found(mesh), mesh);
  EXPECT_EQ(found("..\\..\\meshes\\a.stl"), mesh);
  EXPECT_EQ(found("package://h2_description/meshes/a.stl"), "elsewhere " + mesh);
  EXPECT_EQ(found("../meshes/a.stl"), "elsewhere " + mesh);
  EXPECT_EQ(found("a.stl"), "elsewhere " + mesh);
  EXPECT_EQ(found("package://arm_description/m/b.stl"), "");
  {
    const testing::ScopedEnvironment path("ROS_PACKAGE_PATH", TestFolder() + "/ros:/none");
    EXPECT_EQ(found("package://arm_description/m/b.stl"), far);
  }
  for (const char* none : {"", "/", "package://", "package://h1_description", "file://", "none.stl",
                           "https://example.org/meshes/a.stl", "../../../../../../../../a.stl"}) {
    const std::string name = none;
    EXPECT_EQ(found(name), name.ends_with("/a.stl") && !IsFarAway(name) ? "elsewhere " + mesh : "")
        << name;
  }
}

// The files' meshes, whatever shapes they have: 1 mm is what is wanted of them.
TEST(RobotMeshesReal, UrdfAndMjcfOfOneRobotHaveOneSole) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  struct Case {
    const char *urdf, *mjcf, *joint;
    double depth;
  };
  SoleChoice choice;
  choice.take = SoleChoice::Take::kMeshes;
  for (const Case& one :
       {Case{"unitree_g1/g1_custom_collision_29dof.urdf", "unitree_g1/g1_mocap_29dof.xml",
             "left_ankle_roll_joint", 0.0354},
        Case{"unitree_h1/h1.urdf", "unitree_h1/h1.xml", "right_ankle_joint", 0.07},
        Case{"booster_t1/T1_23dof.urdf", "booster_t1/T1_23dof.xml", "Left_Ankle_Roll", 0.0435}}) {
    for (const char* file : {one.urdf, one.mjcf}) {
      Warnings warnings;
      Robot robot = ReadRobotFile(testing::SharedData(std::string("robots/") + file));
      const int ankle = robot.model.FindSegment(one.joint);
      ReadMeshes(ankle, &robot, &warnings);
      const auto sole = FindSole(robot, ankle, choice, nullptr);
      ASSERT_TRUE(sole) << file;
      EXPECT_NEAR(sole->depth, one.depth, 0.0001) << file;
    }
  }
}

}  // namespace
}  // namespace mmm_converter
