// SPDX-License-Identifier: MIT
#include "common/io/urdf/urdf_model_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "common/io/bytes/file_content.h"
#include "common/io/model_file.h"
#include "common/io/urdf/urdf_document.h"
#include "common/io/urdf/urdf_model_writer.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SourcePath;

// Sums and products of a few numbers of order 1.
constexpr double kUrdfRounding = 1e-14;

std::string Humanoid() { return SourcePath("tests/support/humanoid.urdf"); }

std::string RobotText(const std::string& content) {
  return "<robot name='r'>\n" + content + "\n</robot>";
}

std::string Joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>";
}

/// Two links, the second carried by such a joint.
std::string Hinge(const std::string& type, const std::string& more) {
  return RobotText("<link name='a'/><link name='b'/>\n" + Joint("j", type, "a", "b", more));
}

std::string UrdfMessageOf(const std::string& urdf) {
  ::testing::internal::CaptureStderr();
  std::string message = "no error";
  try {
    ParseUrdfModel(urdf, "r.urdf");
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << urdf;
  return message;
}

constexpr const char* kLimit = "<limit lower='-1' upper='2' effort='1' velocity='1'/>";

TEST(UrdfModel, HasTreeLimitsMassesAndMarkers) {
  Warnings warnings;
  const UrdfModel read = ParseUrdfModel(
      RobotText(
          "<link name='base'><inertial><origin xyz='0.1 0 0' rpy='0 0 1.5707963267948966'/>"
          "<mass value=' 2 '/><inertia ixx='1' ixy='0.1' ixz='0.2' iyy='2' iyz='0.3' izz='2.5'/>"
          "</inertial><visual><geometry><mesh filename='a.stl' scale='broken'/></geometry>"
          "</visual></link>"
          "<link name='arm'/><link name='C7_marker'/>" +
          Joint("shoulder", "revolute", "base", "arm",
                "<origin xyz='0 \t 0\n 1' rpy='0 0 0'/><axis xyz='0 0 2'/>" + std::string(kLimit)) +
          Joint("c7", "fixed", "arm", "C7_marker", "<origin xyz='0.5 0 0' rpy='1 1 1'/>")),
      "r.urdf", &warnings);
  const KinematicModel& model = read.model;
  EXPECT_EQ(model.name(), "r");
  ASSERT_EQ(model.segments().size(), 2u);
  EXPECT_EQ(model.segments()[0].name, "base");
  EXPECT_EQ(model.segments()[0].mass, 2);
  EXPECT_EQ(model.segments()[0].p_SB, Eigen::Vector3d(0.1, 0, 0));
  Eigen::Matrix3d turned;  // by a quarter about z: x is y, y is -x
  turned << 2, -0.1, -0.3, -0.1, 1, 0.2, -0.3, 0.2, 2.5;
  EXPECT_TRUE(model.segments()[0].inertia.isApprox(turned, kUrdfRounding));
  ASSERT_EQ(model.num_joints(), 1);
  EXPECT_EQ(model.joint(0).name, "shoulder");
  EXPECT_EQ(model.joint(0).lower, -1);
  EXPECT_EQ(model.joint(0).upper, 2);
  EXPECT_EQ(model.joint(0).axis, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(model.markers().size(), 1u);
  EXPECT_EQ(model.markers()[0].name, "C7");
  Posture posture;
  posture.joint_angles = Eigen::VectorXd::Constant(1, EIGEN_PI / 2);
  EXPECT_TRUE(
      MarkerPositions(model, posture).col(0).isApprox(Eigen::Vector3d(0, 0.5, 1), kUrdfRounding));
  EXPECT_EQ(read.segment_of_link.at("arm"), "shoulder");
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(UrdfModel, HumanoidIsRead) {
  Warnings warnings;
  const LoadedModel read = ReadModelFile(Humanoid(), &warnings);
  EXPECT_FALSE(read.is_reference);
  EXPECT_EQ(read.model.name(), "humanoid");
  EXPECT_EQ(read.model.num_joints(), 32);
  EXPECT_EQ(read.model.markers().size(), 47u);
  EXPECT_NEAR(read.model.total_mass(), 59.8, 1e-12);  // rounding of a sum
  EXPECT_EQ(read.model.joint(read.model.FindJoint("left_knee")).upper, 2.4);
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(UrdfModel, WhatCanNotMoveIsHeldAndNamed) {
  const auto held = [](const std::string& type, const std::string& more) {
    Warnings warnings;
    UrdfModel read = ParseUrdfModel(Hinge(type, "<axis xyz='0 0 1'/>" + more), "r.urdf", &warnings);
    EXPECT_EQ(read.model.num_joints(), 0);
    EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("r.urdf: joint j (")));
    return read.model.segments()[1].X_PF;
  };
  const std::string limit = "<limit effort='1' velocity='1' ";
  EXPECT_EQ(held("prismatic", limit + "lower='0.2' upper='0.2'/>").translation().z(), 0.2);
  const Eigen::Isometry3d X = held("revolute", limit + "lower='0.5' upper='0.5'/>");
  EXPECT_NEAR(Eigen::AngleAxisd(X.linear()).angle(), 0.5, kUrdfRounding);
}

TEST(UrdfModel, PrismaticJointsSlide) {
  const auto slide = [](const std::string& limits) {
    Warnings warnings;
    UrdfModel read = ParseUrdfModel(
        Hinge("prismatic", "<axis xyz='0 0 2'/><limit effort='1' velocity='1' " + limits + "/>"),
        "r.urdf", &warnings);
    EXPECT_THAT(warnings.texts(), IsEmpty());
    return read.model;
  };
  const KinematicModel model = slide("lower='0.2' upper='1'");
  ASSERT_EQ(model.num_joints(), 1);
  EXPECT_EQ(model.joint(0).type, JointType::kSliding);
  EXPECT_EQ(ZeroPosture(model).joint_angles[0], 0.2);
  const Eigen::Vector3d low = SegmentPoses(model, ZeroPosture(model))[1].translation();
  Posture posture = ZeroPosture(model);
  posture.joint_angles[0] = 0.7;
  const Eigen::Vector3d high = SegmentPoses(model, posture)[1].translation();
  EXPECT_NEAR((high - low).z(), 0.5, kUrdfRounding);
  EXPECT_TRUE(HasNoLimits(slide("lower='-1e9' upper='1e9'").joint(0)));
}

TEST(UrdfModel, MimicJointsFollow) {
  Warnings warnings;
  const UrdfModel read = ParseUrdfModel(
      RobotText(
          "<link name='a'/><link name='b'/><link name='c'/><link name='d'/><link "
          "name='M_marker'/>" +
          Joint("k", "continuous", "a", "b") +
          Joint("j", "continuous", "b", "c", "<mimic joint='k' multiplier='2' offset='0.3'/>") +
          Joint("i", "continuous", "c", "d", "<mimic joint='j' multiplier='-1' offset='0.1'/>") +
          Joint("m", "fixed", "c", "M_marker")),
      "r.urdf", &warnings);
  ASSERT_EQ(read.model.num_joints(), 1);
  const auto angle = [&](const char* name) {
    const Segment& segment = read.model.segments()[read.model.FindSegment(name)];
    EXPECT_EQ(segment.joint, 0);
    return JointValue(segment, 0.5);
  };
  EXPECT_EQ(angle("k"), 0.5);
  EXPECT_NEAR(angle("j"), 2 * 0.5 + 0.3, kUrdfRounding);
  EXPECT_NEAR(angle("i"), -1.3 + 0.1, kUrdfRounding);
  EXPECT_EQ(read.model.markers().size(), 1u);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  const UrdfModel again = ParseUrdfModel(FormatUrdf(read.model, "").xml, "again.urdf");
  EXPECT_EQ(again.model.num_joints(), 1);
  EXPECT_NEAR(JointValue(again.model.segments()[3], 0.5), -1.2, kUrdfRounding);
}

TEST(UrdfModel, MimicsOfWhatDoesNotMoveAreHeld) {
  const UrdfModel read =
      ParseUrdfModel(RobotText("<link name='a'/><link name='b'/><link name='c'/>" +
                               Joint("k", "prismatic", "a", "b",
                                     "<limit lower='0.2' upper='0.2' effort='1' velocity='1'/>") +
                               Joint("j", "continuous", "b", "c",
                                     "<mimic joint='k' multiplier='2' offset='0.3'/>")),
                     "r.urdf");
  EXPECT_EQ(read.model.num_joints(), 0);
  const Segment& held = read.model.segments()[read.model.FindSegment("j")];
  EXPECT_NEAR(Eigen::AngleAxisd(held.X_PF.linear()).angle(), 0.7, kUrdfRounding);
}

TEST(UrdfModel, AFloatingJointUnderAWorldMovesTheRoot) {
  const UrdfModel read =
      ParseUrdfModel(RobotText("<link name='world'/><link name='a'/><link name='b'/>" +
                               Joint("f", "floating", "world", "a", "<origin xyz='0 0 1'/>") +
                               Joint("k", "continuous", "a", "b")),
                     "r.urdf");
  ASSERT_EQ(read.model.segments().size(), 2u);
  EXPECT_FALSE(read.model.is_root_fixed());
  EXPECT_EQ(read.model.segments()[0].name, "a");
  EXPECT_TRUE(read.model.segments()[0].X_PF.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(read.segment_of_link.count("world"), 0u);
}

TEST(UrdfModel, OneMissingLimitCountsAsZero) {
  Warnings warnings;
  const UrdfModel read = ParseUrdfModel(
      Hinge("revolute", "<limit upper='2' effort='1' velocity='1'/>"), "r.urdf", &warnings);
  EXPECT_EQ(read.model.joint(0).lower, 0);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("r.urdf:3: joint 'j': <limit> has no lower, "
                                                      "which URDF takes for 0")));
}

TEST(UrdfModel, JointsWithoutLimitsTurnHalfRoundAndAreTold) {
  for (const char* limit : {"", "<limit/>", "<limit effort='1' velocity='1'/>"}) {
    Warnings warnings;
    const UrdfModel read = ParseUrdfModel(Hinge("revolute", limit), "r.urdf", &warnings);
    EXPECT_DOUBLE_EQ(read.model.joint(0).lower, -EIGEN_PI);
    EXPECT_DOUBLE_EQ(read.model.joint(0).upper, EIGEN_PI);
    EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("r.urdf: has no limits"))) << limit;
  }
  std::string zeros = "<link name='l0'/>";
  for (int i = 0; i < 6; ++i) {
    const std::string number = std::to_string(i), next = std::to_string(i + 1);
    zeros += "<link name='l" + next + "'/>" +
             Joint("j" + number, "revolute", "l" + number, "l" + next,
                   "<limit lower='0' upper='0' effort='0' velocity='0'/>");
  }
  Warnings warnings;
  EXPECT_EQ(ParseUrdfModel(RobotText(zeros), "r.urdf", &warnings).model.num_joints(), 6);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("j0, j1, j2, j3, j4")));
}

TEST(UrdfModel, EndlessJointsHaveNoLimits) {
  for (const std::string& urdf :
       {Hinge("continuous", ""),
        Hinge("revolute", "<limit lower='-1e16' upper='1e16' effort='1' velocity='1'/>")}) {
    Warnings warnings;
    const UrdfModel read = ParseUrdfModel(urdf, "r.urdf", &warnings);
    EXPECT_TRUE(IsEndless(read.model.joint(0)));
    EXPECT_THAT(warnings.texts(), IsEmpty());
    const std::string again = FormatUrdf(read.model, "").xml;
    EXPECT_THAT(again, HasSubstr("type=\"continuous\""));
    EXPECT_TRUE(IsEndless(ParseUrdfModel(again, "again.urdf").model.joint(0)));
  }
}

TEST(UrdfModel, MarkersOfOtherKinds) {
  const UrdfModel read = ParseUrdfModel(
      RobotText("<link name='a'/><link name='M_marker'><inertial><mass value='1'/><inertia ixx='1' "
                "ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link><link name='t_marker'/>"
                "<link name='_marker'/>" +
                Joint("m", "fixed", "a", "M_marker") + Joint("t", "continuous", "a", "t_marker") +
                Joint("u", "fixed", "a", "_marker")),
      "r.urdf");
  ASSERT_EQ(read.model.markers().size(), 1u);  // the second turns, the third has no label
  EXPECT_EQ(read.model.markers()[0].name, "M");
  EXPECT_EQ(read.model.segments()[read.model.markers()[0].segment].name, "m");
  EXPECT_EQ(read.model.total_mass(), 1);
}

TEST(UrdfModel, RootMayBeCalledAsAJoint) {
  const UrdfModel read = ParseUrdfModel(
      RobotText("<link name='j'/><link name='b'/>" + Joint("j", "continuous", "j", "b")), "r.urdf");
  EXPECT_EQ(read.model.segments()[0].name, "j_link");
  EXPECT_EQ(read.model.joint(0).name, "j");
}

TEST(UrdfModel, ImpossibleInertiaIsNamed) {
  Warnings warnings;
  const UrdfModel read = ParseUrdfModel(
      RobotText(
          "<link name='a'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
          "iyz='0' izz='3'/></inertial></link>"),
      "r.urdf", &warnings);
  EXPECT_THAT(warnings.texts(),
              ElementsAre(AllOf(HasSubstr("r.urdf:2: link 'a': no body has its inertia"))));
}

TEST(UrdfModel, ErrorsNameFileAndReason) {
  const std::string two = "<link name='a'/><link name='b'/>";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<robot name='r'><link name='a'>", "r.urdf:1: not well-formed XML"},
      {"<MMM/>", "expected <robot>, found <MMM>"},
      {"<robot><link name='a'/></robot>", "r.urdf: urdfdom can't read it: No name given"},
      {RobotText(""), "No link"},
      {RobotText("<xacro:macro name='m'/>"), "r.urdf:2: <xacro:macro>: is xacro"},
      {RobotText(two), "Two root links found: [a] and [b]"},
      {RobotText(two + Joint("i", "fixed", "a", "b") + Joint("j", "fixed", "b", "a")),
       "link 'a' hangs in a circle of joints"},
      {RobotText("<link name='c'/>" + two + Joint("i", "fixed", "a", "b") +
                 Joint("j", "fixed", "b", "a")),
       "link 'a' hangs in a circle of joints"},
      {RobotText("<link name='a'/>" + Joint("i", "fixed", "a", "a")),
       "link 'a' hangs in a circle of joints"},
      {RobotText("<link name='c'/>" + two + Joint("i", "fixed", "a", "c") +
                 Joint("j", "fixed", "b", "c") + Joint("k", "fixed", "a", "b")),
       "link 'c' is the child of both the joints 'i' and 'j'"},
      {RobotText(two + Joint("j", "fixed", "a", "z")), "child link [z] of joint [j] not found"},
      {RobotText(two + Joint("j", "fixed", "z", "b")), "parent link [z] of joint [j] not found"},
      {RobotText(two + Joint("j", "fixed", "a", "b") + Joint("j", "fixed", "a", "b")),
       "not unique"},
      {RobotText("<link name='a'/><link name='a'/>"), "not unique"},
      {RobotText("<link name='a'/><link name='b'/><link name='c'/>" +
                 Joint("k", "fixed", "a", "b") + Joint("j", "floating", "a", "c")),
       "r.urdf:2: joint 'j': floating joints are not supported"},
      {RobotText("<link name='a'/><link name='b'/><link name='c'/>" +
                 Joint("k", "continuous", "a", "b", "<mimic joint='j'/>") +
                 Joint("j", "continuous", "a", "c", "<mimic joint='k'/>")),
       "joint 'j': mimics joints in a circle"},
      {Hinge("planar", ""), "r.urdf:3: joint 'j': planar joints are not supported"},
      {Hinge("continuous", "<mimic joint='j'/>"), "r.urdf:3: joint 'j': mimics itself"},
      {Hinge("continuous", "<mimic joint='k'/>"),
       "r.urdf:3: joint 'j': mimics joint 'k', which does not exist"},
      {RobotText("<link name='a'/><link name='b'/><link name='c'/>" +
                 Joint("k", "continuous", "a", "b") +
                 Joint("j", "continuous", "a", "c", "<mimic joint='k' multiplier='1e140'/>")),
       "joint 'j': its <mimic> multiplies by 1e+140"},
      {RobotText("<link name='a'/><link name='b'/><link name='c'/>" +
                 Joint("k", "continuous", "a", "b") +
                 Joint("j", "continuous", "a", "c", "<mimic joint='k' offset='1e200'/>")),
       "adds 1e+200"},
      {Hinge("ball", ""), "[j] has no known type [ball]"},
      {Hinge("prismatic", ""), "Joint [j] is of type PRISMATIC without limits"},
      {Hinge("revolute", "<limit lower='2' upper='1' effort='1' velocity='1'/>"),
       "joint 'j': its limits are crossed: lower=\"2\" is above upper=\"1\""},
      {Hinge("revolute", "<limit lower='0' upper='90' effort='1' velocity='1'/>"),
       "joint 'j': its limits 0 to 90 are not in radian"},
      {Hinge("continuous", "<axis xyz='0 0 0'/>"), "joint 'j': its <axis> has no direction"},
      {Hinge("continuous", "<axis xyz='nan 0 0'/>"), "r.urdf: urdfdom can't read it"},
      {Hinge("fixed", "<origin xyz='1e400 0 0'/>"), "r.urdf: urdfdom can't read it"},
      {Hinge("fixed", "<origin xyz='1e300 0 0'/>"), "joint 'j': its origin is more than 100 m"},
      {Hinge("fixed", "<origin xyz='1 2'/>"), "r.urdf: urdfdom can't read it"},
      {RobotText(
           "<link name='a'><inertial><mass value='-1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
           "iyz='0' izz='1'/></inertial></link>"),
       "r.urdf:2: link 'a': its mass of -1 kg is outside"},
      {RobotText("<link name=''/>"), "use a name of letters"},
      {RobotText("<link NAME='a' name='b'/><Link name='c'/><Joint name='j'/>"), "no error"},
      {RobotText("<link name='\xff'/>"), "use a name of letters"}};
  for (const auto& [urdf, message] : cases)
    EXPECT_THAT(UrdfMessageOf(urdf), HasSubstr(message)) << urdf;
}

TEST(UrdfModel, DeepAndLongFilesEndWithAnError) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(UrdfMessageOf(RobotText("<link name='a'>" + deep + "</link>")),
              HasSubstr("nested too deep"));
  std::string chain = "<link name='l0'/>";
  for (std::size_t i = 1; i < kMaxUrdfLinks; ++i) {
    const std::string name = "l" + std::to_string(i);
    chain += "<link name='" + name + "'/>" +
             Joint("j" + name, "continuous", "l" + std::to_string(i - 1), name);
  }
  EXPECT_EQ(ParseUrdfModel(RobotText(chain), "r.urdf").model.num_joints(),
            static_cast<int>(kMaxUrdfLinks) - 1);
  EXPECT_THAT(UrdfMessageOf(RobotText(chain + "<link name='second root'/>")),
              HasSubstr("has 4097 links, more than the 4096"));
}

TEST(UrdfModel, DamagedFilesAreReadOrRefused) {
  const std::string whole = ReadFileContent(Humanoid());
  const std::string bytes = "<>/\"= -0a9e.\xff&;";
  std::mt19937 random(1);
  int refused = 0;
  ::testing::internal::CaptureStderr();
  for (int run = 0; run < 200; ++run) {
    std::string content = whole;
    for (int i = 0; i < 3; ++i) content[random() % content.size()] = bytes[random() % bytes.size()];
    try {
      ParseUrdfModel(content, "r.urdf");
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("r.urdf"));
      ++refused;
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(refused, 20);
  EXPECT_LT(refused, 200);
}

TEST(UrdfModel, AnInertialThatUrdfdomLeavesOutIsSaid) {
  const auto link = [](const std::string& mass, const std::string& inertia) {
    return RobotText("<link name='a'>\n<inertial><mass value='" + mass + "'/>" + inertia +
                     "</inertial></link>");
  };
  const std::string inertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";
  for (const char* mass : {"8,5", "nan", "1e400", "", "8 kg"}) {
    EXPECT_THAT(UrdfMessageOf(link(mass, inertia)),
                HasSubstr(std::string("r.urdf:3: link 'a': <mass value=\"") + mass))
        << mass;
  }
}

}  // namespace
}  // namespace mmm_converter
