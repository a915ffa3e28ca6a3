// SPDX-License-Identifier: MIT
#include "common/io/mjcf/mjcf_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "common/io/model_file.h"
#include "common/io/robot/robot_file.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SharedData;

constexpr double kMjcfRounding = 1e-14;  // sums and products of a few numbers of order 1
constexpr double kGoldenDigits = 1e-9;   // that were printed

using Files = std::map<std::string, std::string>;

Robot ParseWith(const Files& files, const std::string& mjcf, Warnings* warnings = nullptr) {
  const auto read = [&](const std::string& name) -> std::optional<std::string> {
    const auto found = files.find(name);
    return found == files.end() ? std::nullopt : std::make_optional(found->second);
  };
  return ParseMjcf(mjcf, "r.xml", read, warnings);
}

/// A model of one body, that floats, with this in it.
std::string Floating(const std::string& content, const std::string& before = "",
                     const std::string& behind = "") {
  return "<mujoco>" + before + "<worldbody><body name='root' pos='0 0 1'><freejoint/>" + content +
         "</body></worldbody>" + behind + "</mujoco>";
}

const Segment& SegmentOf(const Robot& robot, const std::string& name) {
  return robot.model.segments()[static_cast<std::size_t>(robot.model.FindSegment(name))];
}

// Everything at once; where its bodies are was computed by MuJoCo 3.14.
constexpr const char* kEverything = R"(<mujoco model="all">
<compiler angle="degree" eulerseq="zYx"/>
<include file="inc.xml"/>
<default>
  <geom type="capsule" size="0.05 0.2" contype="0" conaffinity="0"/>
  <joint axis="0 1 0" range="-90 90"/>
  <default class="leg"><joint axis="1 0 0"/><geom contype="1"/>
    <default class="foot"><geom type="box" size="0.1 0.05 0.02" axisangle="0 0 1 30"/></default></default>
  <default class="slide"><joint type="slide" range="-0.5 0.5"/></default>
</default>
<worldbody>
 <geom type="plane" size="1 1 1"/>
 <body name="crate" pos="3 0 0"><freejoint/><geom type="box" size="1 1 1"/></body>
 <frame pos="0 0 1" euler="10 20 30">
 <body name="pelvis" pos="0 0 0.5" euler="0 0 20"><joint type="free" name="root"/>
   <geom fromto="0 -0.1 0 0 0.1 0"/>
   <body name="thigh" pos="0 0.1 0" childclass="leg" xyaxes="1 0.1 0 0 1 0.2">
     <joint name="hx" pos="0 0 0.02"/><joint name="hy" class="main" pos="0.01 0 0"/>
     <joint name="hz" axis="0 0 2" pos="0 0.03 0" ref="15" limited="false"/>
     <geom type="ellipsoid" size="0.1 0.1 0.2" pos="0 0 -0.2" zaxis="0.1 0.2 -1"/>
     <frame euler="0 0 45" pos="0.01 0.02 0" childclass="foot">
       <body name="shank" pos="0 0 -0.4" axisangle="1 1 0 20">
         <joint name="k" class="slide" pos="0 0 0.1"/>
         <joint name="k2" class="leg" pos="0 0 0.2" range="-10 140"/>
         <geom pos="0 0 -0.3"/><geom class="leg" pos="0 0 -0.1" quat="1 2 3 4"/>
         <geom euler="10 20 30" mass="0.3"/>
         <site name="sole" pos="0 0 -0.35"/>
         <body name="toe" pos="0 0 -0.3"><joint name="t" class="leg"/><geom/></body>
       </body>
     </frame>
   </body>
   <frame childclass="slide"><include file="arm.xml"/></frame>
 </body></frame>
</worldbody></mujoco>)";

const Files kParts = {
    {"inc.xml", "<mujoco><default><site size='0.1'/></default></mujoco>"},
    {"arm.xml",
     "<mujocoinclude><body name='arm' pos='0 0 0.4'><joint name='s' axis='1 1 0'/><geom "
     "size='0.1'/>"
     "<inertial mass='2' pos='0 0 0.1' fullinertia='0.2 0.3 0.4 0.01 0.02 0.03'/></body>"
     "</mujocoinclude>"}};

TEST(MjcfRobot, MovesAsMuJoCoMovesIt) {
  const Robot robot = ParseWith(kParts, kEverything);
  EXPECT_EQ(robot.model.name(), "all");
  Posture posture;
  posture.position = Eigen::Vector3d(0.1, 0.2, 1);
  posture.orientation = Eigen::Quaterniond(0.8, 0.36, -0.48, 0);
  posture.joint_angles.resize(7);
  posture.joint_angles << 0.3, -0.4, 0.5, 0.1, -0.6, 0.7, 0.2;
  ASSERT_EQ(robot.model.num_joints(), 7);
  const auto X_WS = SegmentPoses(robot.model, posture);
  const std::vector<std::pair<std::string, std::array<double, 7>>> golden = {
      {"pelvis", {0.1, 0.2, 1, 0.8, 0.36, -0.48, 0}},
      {"thigh",
       {0.065254143, 0.276600609, 1.067439976, 0.573384707, 0.468783975, -0.660508946,
        0.123286231}},
      {"shank",
       {0.041502783, 0.6033062, 1.269599436, 0.508426942, 0.513281445, -0.596443566, 0.349713132}},
      {"toe",
       {0.115750813, 0.885036358, 1.341121098, 0.301599314, 0.656501067, -0.440366944,
        0.533030165}},
      {"arm", {-0.179820825, 0.02548972, 1.302070303, 0.8, 0.36, -0.48, 0}}};
  ASSERT_EQ(robot.links.size(), golden.size());
  for (std::size_t i = 0; i < golden.size(); ++i) {
    const Robot::Link& link = robot.links[i];
    const auto& [name, g] = golden[i];
    EXPECT_EQ(link.name, name);
    const Eigen::Isometry3d X = X_WS[static_cast<std::size_t>(link.segment)] * link.X_SL;
    EXPECT_LT((X.translation() - Eigen::Vector3d(g[0], g[1], g[2])).norm(), 2 * kGoldenDigits);
    EXPECT_LT(
        Eigen::Quaterniond(X.linear()).angularDistance(Eigen::Quaterniond(g[3], g[4], g[5], g[6])),
        1e-7)  // angularDistance's own rounding is the root of a double's
        << name;
  }
  EXPECT_NEAR(SegmentOf(robot, "hz").mass, 8.377580409572783, 1e-12);
  EXPECT_NEAR(SegmentOf(robot, "k2").mass, 4.765191429188093, 1e-12);
  EXPECT_EQ(robot.shapes.size(), 5u);  // what the class "leg" lets touch
  const auto sole = FindSole(robot, robot.model.FindSegment("t"), {}, nullptr);
  ASSERT_TRUE(sole);
  EXPECT_EQ(sole->said, "1 box of toe");
}

TEST(MjcfRobot, ThreeSlidesAndThreeHingesOfTheRootAreAFreeJoint) {
  const auto model = [](const std::string& last, const std::string& child) {
    return "<mujoco><compiler angle='radian'/><worldbody><body name='p' pos='0 0 1'>"
           "<joint name='tx' type='slide' axis='1 0 0'/><joint name='tz' type='slide' axis='0 0 "
           "1'/>"
           "<joint name='ty' type='slide' axis='0 1 0' range='-5 5'/>"
           "<joint name='rx' axis='1 0 0'/><joint name='ry' axis='0 1 0'/><joint name='rz' axis='" +
           last + "'/><geom size='0.1'/>" + child + "</body></worldbody></mujoco>";
  };
  const std::string child = "<body name='c'><joint name='j'/><geom size='0.1'/></body>";
  Warnings warnings;
  const Robot robot = ParseWith({}, model("0 0 1", child), &warnings);
  EXPECT_FALSE(robot.model.is_root_fixed());
  EXPECT_EQ(robot.model.num_joints(), 1);
  EXPECT_EQ(robot.model.segments()[0].name, "p");
  EXPECT_EQ(robot.model.segments()[0].X_PF.translation().norm(), 0);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("of 'p' (tx to rz) are one free joint")));
  // Two axes alike, or nothing that it carries: a machine of six joints.
  EXPECT_EQ(ParseWith({}, model("0 1 0", child)).model.num_joints(), 7);
  EXPECT_EQ(ParseWith({}, model("0 0 1", "")).model.num_joints(), 6);
}

TEST(MjcfRobot, JointsHaveTheirRanges) {
  const Robot robot = ParseWith(kParts, kEverything);
  const double degree = EIGEN_PI / 180;
  EXPECT_NEAR(SegmentOf(robot, "k2").upper, 140 * degree, kMjcfRounding);
  EXPECT_EQ(SegmentOf(robot, "k").type, JointType::kSliding);
  EXPECT_EQ(SegmentOf(robot, "k").upper, 0.5);
  EXPECT_TRUE(IsEndless(SegmentOf(robot, "hz")));
  EXPECT_NEAR(SegmentOf(robot, "hz").rest, 15 * degree, kMjcfRounding);
  EXPECT_NEAR(JointValue(SegmentOf(robot, "hz"), 15 * degree), 0, kMjcfRounding);
  EXPECT_TRUE((robot.velocity_limits.array() == std::numeric_limits<double>::infinity()).all());
}

TEST(MjcfRobot, RangesCountAsEachGenerationHasThem) {
  const std::string joint = "<body><joint name='j' range='-1 1'/><geom size='1'/></body>";
  const std::string radian = "<compiler angle='radian'/>";
  EXPECT_EQ(SegmentOf(ParseWith({}, Floating(joint, radian)), "j").upper, 1);
  Warnings warnings;
  const Robot old =
      ParseWith({}, Floating(joint, radian + "<compiler autolimits='false'/>"), &warnings);
  EXPECT_TRUE(IsEndless(SegmentOf(old, "j")));
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("r.xml:1: joint 'j': its range does not")));
  const std::string limited = "<body><joint name='j' limited='true' range='-1 1'/></body>";
  EXPECT_EQ(
      SegmentOf(ParseWith({}, Floating(limited, radian + "<compiler autolimits='false'/>")), "j")
          .lower,
      -1);
}

TEST(MjcfRobot, WithoutAFreeJointItStandsOnTheWorld) {
  const Robot robot = ParseWith(
      {},
      "<mujoco><worldbody><body name='table'><geom size='1'/></body>"
      "<body name='left' pos='0 1 0'><geom size='0.1'/><body pos='0 0 1'><joint name='a'/>"
      "<geom size='0.1'/></body></body>"
      "<body name='right' pos='0 -1 0'><joint name='world'/><geom size='0.1'/></body>"
      "</worldbody></mujoco>");
  EXPECT_TRUE(robot.model.is_root_fixed());
  EXPECT_EQ(robot.model.num_joints(), 2);
  EXPECT_EQ(robot.links.size(), 3u);
  const auto X_WS = SegmentPoses(robot.model, ZeroPosture(robot.model));
  EXPECT_EQ(X_WS[static_cast<std::size_t>(robot.model.FindSegment("a"))].translation(),
            Eigen::Vector3d(0, 1, 1));
}

TEST(MjcfRobot, AStartPoseThatIsTurnedUprightTellsWhereUpIs) {
  const auto standing = [](const char* euler) {
    return ParseWith({}, std::string("<mujoco><worldbody><body euler='") + euler +
                             "'><freejoint/><geom size='1'/><body><joint/><geom size='1'/></body>"
                             "</body></worldbody></mujoco>")
        .model.standing();
  };
  EXPECT_TRUE((standing("90 0 0") * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(standing("0 20 0").isApprox(Eigen::Quaterniond::Identity()));
  EXPECT_TRUE(standing("0 0 90").isApprox(Eigen::Quaterniond::Identity()));
}

TEST(MjcfRobot, WhereNothingTouchesAllShapesDo) {
  const std::string shapes =
      "<geom size='1' contype='0' conaffinity='0'/><body><joint/><geom "
      "size='0.1' contype='0' conaffinity='0'/>";
  Warnings warnings;
  EXPECT_EQ(ParseWith({}, Floating(shapes + "</body>"), &warnings).shapes.size(), 2u);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("count as touching")));
  EXPECT_EQ(ParseWith({}, Floating(shapes + "<geom size='0.2'/></body>")).shapes.size(), 1u);
}

TEST(MjcfRobot, LoopsNameTheirSegments) {
  const Robot robot = ParseWith(
      {}, Floating("<geom size='1'/><body name='a'><joint name='q'/><geom size='1'/></body><body "
                   "name='b'><joint name='r'/><geom size='1'/></body>",
                   "", "<equality><connect body1='a' body2='b' anchor='0 0 0'/></equality>"));
  ASSERT_EQ(robot.ties.size(), 1u);
  EXPECT_EQ(robot.ties[0][0], robot.model.FindSegment("q"));
  EXPECT_EQ(robot.ties[0][1], robot.model.FindSegment("r"));
}

TEST(MjcfRobot, EqualJointsFollowAndOtherEqualitiesAreNamed) {
  Warnings warnings;
  const Robot robot = ParseWith(
      {},
      Floating("<body><joint name='a' ref='0.5'/><geom size='1'/></body><body><joint name='b' "
               "ref='0.2'/>"
               "<geom size='1'/></body><body><joint name='c'/><geom size='1'/></body>",
               "<compiler angle='radian'/>",
               "<equality><joint joint1='b' joint2='a' polycoef='0.1 2'/>"
               "<joint joint1='c' polycoef='0.3'/><connect name='loop' body1='x' anchor='0 0 0'/>"
               "</equality>"),
      &warnings);
  ASSERT_EQ(robot.model.num_joints(), 1);
  // The follower's own q; where its body turns to, counts from its ref.
  const Segment& follower = SegmentOf(robot, "b");
  EXPECT_NEAR(JointValue(follower, 0.7), 0.2 + 0.1 + 2 * 0.2, kMjcfRounding);
  const Eigen::Isometry3d X = follower.X_PF * JointTransform(follower, 0.7);
  EXPECT_NEAR(Eigen::AngleAxisd(X.linear()).angle(), 0.1 + 2 * 0.2, 1e-7);  // acos at a cosine
  EXPECT_EQ(SegmentOf(robot, "c").type, JointType::kFixed);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("<equality><connect> is not kept")));
}

// Neither what leads nor what follows is held, whatever comes first.
TEST(MjcfRobot, AHeldJointThatLeadsOrFollowsIsSaidAndNotHeld) {
  for (const char* held : {"a", "b"}) {
    Warnings warnings;
    const Robot robot =
        ParseWith({},
                  Floating("<body><joint name='a'/><geom size='1'/></body><body><joint name='b'/>"
                           "<geom size='1'/></body>",
                           "",
                           std::string("<equality><joint joint1='b' joint2='a'/><joint joint1='") +
                               held + "' polycoef='0.3'/></equality>"),
                  &warnings);
    EXPECT_EQ(robot.model.num_joints(), 1);
    EXPECT_NE(SegmentOf(robot, held).type, JointType::kFixed);
    EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("is not kept")));
  }
}

TEST(MjcfRobot, IsAModelWithMarkers) {
  const std::string file = testing::TestFolder() + "/robot.xml";
  std::ofstream(file) << Floating(
      "<body name='arm'><joint name='a'/><geom size='1'/>"
      "<site name='M_marker' pos='0 0 0.3'/></body>");
  const LoadedModel loaded = ReadModelFile(file, nullptr);
  EXPECT_FALSE(loaded.is_reference);
  ASSERT_EQ(loaded.model.markers().size(), 1u);
  EXPECT_EQ(loaded.model.markers()[0].name, "M");
  EXPECT_EQ(loaded.segment_of_link.at("arm"), "a");
}

std::string MjcfMessageOf(const std::string& mjcf, const Files& files = {}) {
  try {
    ParseWith(files, mjcf);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MjcfRobot, ErrorsNameFileLineAndReason) {
  const auto with_joint = [](const std::string& content) {
    return Floating("<body name='b'><joint name='j'/>" + content + "</body>");
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<mujoco>", "r.xml:1: not well-formed XML"},
      {"<robot/>", "r.xml:1: not an MJCF: expected <mujoco>, found <robot>"},
      {"<mujoco/>", "r.xml: is no robot: no body has a hinge or a slide"},
      {Floating("<geom size='1'/>"), "is no robot"},
      {Floating("<body><joint type='ball' name='j'/></body>"),
       "joint 'j': of type \"ball\", which is not read; use three hinges"},
      {Floating("<body><freejoint/></body>"), "a free joint must be the only one"},
      {with_joint("<joint name='j'/>"), "<joint name=\"j\">: a second one of that name"},
      {with_joint("<body name='b'/>"), "<body name=\"b\">: a second one of that name"},
      {with_joint("<joint axis='0 0 0'/>"), "its axis has no direction"},
      {with_joint("<joint axis='nan 0 1'/>"), "<joint axis=\"nan 0 1\">: are no numbers"},
      {with_joint("<joint range='1 -1' limited='true'/>"), "its range is crossed or empty"},
      {with_joint("<geom type='blob' size='1'/>"), "there is no such type"},
      {with_joint("<geom type='box' size='1'/>"), "<geom size=\"1\">: use 3 numbers"},
      {with_joint("<geom size='-1'/>"), "needs a size of 1 number above 0"},
      {with_joint("<geom class='c' size='1'/>"), "<geom class=\"c\">: there is no <default>"},
      {with_joint("<body childclass='c'/>"), "<body childclass=\"c\">: there is no <default>"},
      {with_joint("<body quat='0 0 0 0'/>"), "<body quat=\"0 0 0 0\">: has no direction"},
      {with_joint("<body quat='1 0 0 0' euler='0 0 1'/>"), "<body>: has its orientation twice"},
      {with_joint("<body pos='1e300 0 0'/>"), "are no numbers that a robot has"},
      {with_joint("<replicate count='100000000'/>"), "<replicate> makes bodies and is not read"},
      {with_joint("<attach model='m'/>"), "<attach> makes bodies"},
      {with_joint("<thing/>"), "<thing> in a body is not known"},
      {with_joint("<inertial pos='0 0 0'/>"), "<inertial> needs a mass"},
      {Floating("", "<compiler eulerseq='xyw'/>"), "use three letters of xyzXYZ"},
      {Floating("", "<compiler coordinate='global'/>"), "is of an old version"},
      {Floating("", "<default><default/></default>"), "<default> inside another without a class"},
      {Floating("", "<default><default class='a'><default class='a'/></default></default>"),
       "a second <default class=\"a\">"},
      {Floating("<body><joint name='j'/></body>", "",
                "<equality><joint joint1='j' joint2='k'/></equality>"),
       "<equality><joint>: there is no joint 'k'"},
      {"<mujoco><worldbody><body name='a'><freejoint/><body><joint/></body></body><body name='b'>"
       "<freejoint/><body><joint/></body></body></worldbody></mujoco>",
       "r.xml: has two robots, 'a' and 'b'"},
      {"<mujoco>\n<include file='nowhere.xml'/></mujoco>",
       "r.xml:2: includes nowhere.xml, which is not there"},
      {"<mujoco><include/></mujoco>", "r.xml:1: <include> without a file"}};
  for (const auto& [mjcf, message] : cases) {
    EXPECT_THAT(MjcfMessageOf(mjcf), HasSubstr(message)) << mjcf;
  }
}

TEST(MjcfRobot, IncludesAreReadOnceAndNamed) {
  const std::string both = "<mujoco><include file='a.xml'/><include file='a.xml'/></mujoco>";
  const Files circle = {{"a.xml", "<m>\n<include file='sub/b.xml'/></m>"},
                        {"sub/b.xml", "<m><include file='c.xml'/></m>"},
                        {"sub/c.xml", "<m><include file='a.xml'/></m>"}};
  EXPECT_THAT(MjcfMessageOf(both, {{"a.xml", "<m/>"}}), HasSubstr("a.xml is included a second"));
  EXPECT_THAT(MjcfMessageOf("<mujoco><include file='a.xml'/></mujoco>", circle),
              HasSubstr("r.xml: sub/c.xml:1: a.xml is included a second time"));
  EXPECT_THAT(MjcfMessageOf("<mujoco><include file='r.xml'/></mujoco>", {{"r.xml", "<mujoco/>"}}),
              HasSubstr("r.xml is included a second time, or includes itself"));
  EXPECT_THAT(MjcfMessageOf(Floating("<body><joint name='j'/><include file='a.xml'/></body>"),
                            {{"a.xml", "<m>\n<geom size='x'/></m>"}}),
              HasSubstr("r.xml: a.xml:2: <geom size=\"x\">"));
}

TEST(MjcfRobot, DeepAndLongFilesEndWithAnError) {
  std::string deep, many;
  for (int i = 0; i < 100'000; ++i) deep += "<body>";
  EXPECT_THAT(MjcfMessageOf(Floating(deep)), HasSubstr("nested too deep"));
  for (int i = 0; i < 100'000; ++i) many += "<body><joint/><geom size='1'/></body>";
  EXPECT_THAT(MjcfMessageOf(Floating(many)), HasSubstr("more than the 4096 bodies"));
  std::string shapes;
  for (int i = 0; i < 100'001; ++i) shapes += "<geom contype='0' conaffinity='0' size='1'/>";
  EXPECT_THAT(MjcfMessageOf(Floating(shapes)), HasSubstr("more than 100000 shapes and sites"));
  EXPECT_THAT(MjcfMessageOf(std::string(std::size_t{1} << 24, '\n') + "<mujoco/>"),
              HasSubstr("which no robot has"));
  Files chain;
  for (int i = 0; i < 200; ++i) {
    chain[std::to_string(i)] =
        "<m><body><include file='" + std::to_string(i + 1) + "'/></body></m>";
  }
  EXPECT_THAT(MjcfMessageOf(Floating("<include file='0'/>"), chain),
              HasSubstr("more than 100 files"));
}

// Their files agree to the six digits of their quaternions.
TEST(MjcfRobotReal, AgreesWithTheUrdfOfTheSameRobot) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  const std::vector<std::pair<std::string, std::string>> files = {
      {"unitree_g1/g1_custom_collision_29dof.urdf", "unitree_g1/g1_mocap_29dof.xml"},
      {"unitree_h1/h1.urdf", "unitree_h1/h1.xml"},
      {"booster_t1/T1_23dof.urdf", "booster_t1/T1_23dof.xml"}};
  for (const auto& [urdf_file, mjcf_file] : files) {
    Warnings warnings;
    const Robot urdf = ReadRobotFile(SharedData("robots/" + urdf_file));
    const Robot mjcf = ReadRobotFile(SharedData("robots/" + mjcf_file), &warnings);
    EXPECT_THAT(warnings.texts(), IsEmpty());
    ASSERT_EQ(urdf.model.num_joints(), mjcf.model.num_joints());
    for (int j = 0; j < urdf.model.num_joints(); ++j) {
      EXPECT_EQ(urdf.model.joint(j).name, mjcf.model.joint(j).name);
    }
    SeededRandom random(1);
    for (int run = 0; run < 20; ++run) {
      const Posture posture = testing::RandomPosture(urdf.model, random);
      const auto of_urdf = SegmentPoses(urdf.model, posture);
      const auto of_mjcf = SegmentPoses(mjcf.model, posture);
      for (int j = 0; j < urdf.model.num_joints(); ++j) {
        const Eigen::Vector3d difference =
            of_urdf[static_cast<std::size_t>(urdf.model.joint_segment(j))].translation() -
            of_mjcf[static_cast<std::size_t>(mjcf.model.joint_segment(j))].translation();
        EXPECT_LT(difference.norm(), 1e-6) << mjcf.model.joint(j).name;
      }
    }
  }
}

}  // namespace
}  // namespace mmm_converter
