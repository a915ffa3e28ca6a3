// SPDX-License-Identifier: MIT
#include "common/io/mmm/mmm_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A model of a root and, as its child, a node `arm` with this content, which begins in line 3.
std::string Model(const std::string& arm, const std::string& more = "") {
  return "<Robot Type='Test' RootNode='root_joint'>\n"
         "<RobotNode name='root_joint'><Child name='arm'/></RobotNode>\n"
         "<RobotNode name='arm'>" +
         arm + "</RobotNode>\n" + more + "</Robot>";
}

Segment ReadArm(const std::string& arm) {
  Warnings warnings;
  const KinematicModel read = ParseMmmModel(Model(arm), "m.xml", &warnings);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  return read.segments().at(1);
}

std::string ErrorOf(const std::string& xml) {
  try {
    ParseMmmModel(xml, "m.xml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MmmModel, ReadsTranslationsInEachUnit) {
  for (const char* text :
       {"x='1' y='20' z='-300'", "x='1' y='20' z='-300' units='mm'",
        "x='.1' y='2' z='-30' unit='cm'", "x='1e-3' y='+0.02' z='-0.3' Units='m'"}) {
    const Segment arm = ReadArm(std::string("<Transform><Translation ") + text + "/></Transform>");
    // Tolerance: rounding of the factor 1e-3.
    EXPECT_TRUE(arm.X_PF.translation().isApprox(Eigen::Vector3d(0.001, 0.02, -0.3), 1e-15)) << text;
    EXPECT_EQ(arm.X_PF.linear(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(arm.type, JointType::kFixed);
  }
}

TEST(MmmModel, ReadsRollPitchYawInRadiansAndDegrees) {
  const Eigen::Matrix3d expected = RotationFromRpy({M_PI / 6, M_PI / 4, -M_PI / 2});
  for (const char* text :
       {"roll='30' pitch='45' yaw='-90' unit='degree'",
        "roll='0.523598775598' pitch='0.785398163397' yaw='-1.570796326795'",
        "roll='0.523598775598' pitch='0.785398163397' yaw='-1.570796326795' units='radian'"}) {
    const Segment arm = ReadArm(std::string("<TRANSFORM><RollPitchYaw ") + text + "/></TRANSFORM>");
    EXPECT_TRUE(arm.X_PF.linear().isApprox(expected, 1e-11)) << text;  // 12 digits in the text
  }
}

TEST(MmmModel, MakesTheNearestRotationOfRoundedMatrices) {
  const Segment arm = ReadArm(
      "<Transform><Matrix4x4 units='cm'><row1 c1='1' c2='0' c3='0' c4='2'/>"
      "<row2 c1='0' c2='.707' c3='-.707' c4='0'/><Row3 c1='0' c2='.707' c3='.707' c4='0'/>"
      "<row4 c1='0' c2='0' c3='0' c4='1'/></Matrix4x4></Transform>");
  // The rounding to three digits only scaled the two rows; what remains is rounding of the SVD.
  EXPECT_TRUE(arm.X_PF.linear().isApprox(RotationFromRpy({M_PI / 4, 0, 0}), 1e-14));
  EXPECT_NEAR(arm.X_PF.translation().x(), 0.02, 1e-16);
}

TEST(MmmModel, ReadsJointsInAnyCaseAndUnit) {
  const Segment arm = ReadArm(
      "<joint Type='Revolute'><AXIS X='0' Y='0' Z='-2'/><Limits Lo='-90' Hi='45' unit='degree'/>"
      "<MaxTorque value='-1'/></joint>");
  EXPECT_EQ(arm.type, JointType::kRevolute);
  EXPECT_EQ(arm.axis, Eigen::Vector3d(0, 0, -1));
  EXPECT_DOUBLE_EQ(arm.lower, -M_PI / 2);
  EXPECT_DOUBLE_EQ(arm.upper, M_PI / 4);
  EXPECT_EQ(arm.joint, 0);
  const Segment slide = ReadArm(
      "<Transform><Translation x='0' y='0' z='22'/></Transform><Joint type='prismatic'>"
      "<TranslationDirection x='0' y='0' z='1'/><limits lo='0' hi='2.2' units='cm'/></Joint>");
  EXPECT_EQ(slide.type, JointType::kPrismatic);
  EXPECT_NEAR(slide.upper, 0.022, 1e-16);
  EXPECT_EQ(slide.joint, -1);
}

TEST(MmmModel, ReadsPhysics) {
  const Segment arm = ReadArm(
      "<Physics><Mass unit='kg' value='0.5'/><CoM location='Custom' x='10' y='0' z='-3'/>"
      "<InertiaMatrix><row1 c1='1' c2='.1' c3='0'/><row2 c1='.1' c2='2' c3='0'/>"
      "<row3 c1='0' c2='0' c3='2.5'/></InertiaMatrix></Physics>");
  EXPECT_EQ(arm.mass, 0.5);
  EXPECT_TRUE(arm.p_SB.isApprox(Eigen::Vector3d(0.01, 0, -0.003), 1e-15));
  Eigen::Matrix3d inertia;
  inertia << 1, 0.1, 0, 0.1, 2, 0, 0, 0, 2.5;
  EXPECT_EQ(arm.inertia, inertia);
}

TEST(MmmModel, ReadsPositionSensorsAndSkipsWhatItDoesNotKnow) {
  Warnings warnings;
  const KinematicModel read = ParseMmmModel(
      Model("<Sensor type='position' name='M1'><Transform><Translation x='1' y='2' "
            "z='3'/></Transform>"
            "</Sensor><Sensor type='imu' name='I'/><Sensor type='Position' name='M2'/>"
            "<Visualization><File type='inventor'>arm.iv</File></Visualization><Nonsense/>",
            "<SomethingNew/>"),
      "m.xml", &warnings);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  EXPECT_EQ(read.name(), "Test");
  ASSERT_EQ(read.markers().size(), 2u);
  EXPECT_EQ(read.markers()[0].segment, 1);
  EXPECT_TRUE(read.markers()[0].p_SM.isApprox(Eigen::Vector3d(0.001, 0.002, 0.003), 1e-15));
  EXPECT_EQ(read.markers()[1].p_SM, Eigen::Vector3d::Zero());
}

TEST(MmmModel, DropsVirtualNodesAboveTheRootAlsoFromNodeSets) {
  Warnings warnings;
  const KinematicModel read = ParseMmmModel(
      "<Robot RootNode='Virtual_Root'><RobotNode name='leg'/>"
      "<RobotNode name='root_joint'><Children><Child name='leg'/></Children></RobotNode>"
      "<RobotNode name='Virtual_X'><Joint type='prismatic'><TranslationDirection x='1' y='0' "
      "z='0'/>"
      "<Limits unit='m' lo='-10' hi='10'/></Joint><Child name='root_joint'/></RobotNode>"
      "<RobotNode name='Virtual_Root'><Child name='Virtual_X'/></RobotNode>"
      "<RobotNodeSet name='All'><Node name='Virtual_X'/><Node name='root_joint'/><Node name='leg'/>"
      "</RobotNodeSet></Robot>",
      "m.xml", &warnings);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  ASSERT_EQ(read.segments().size(), 2u);
  EXPECT_EQ(read.segments()[0].name, "root_joint");
  EXPECT_THAT(read.node_sets().at("All"), ElementsAre("root_joint", "leg"));
}

TEST(MmmModel, FindsTheRootOfAModelThatDoesNotNameIt) {
  const KinematicModel read = ParseMmmModel(
      "<Robot><RobotNode name='a'/><RobotNode name='b'><Child name='a'/></RobotNode></Robot>",
      "m.xml");
  EXPECT_EQ(read.segments()[0].name, "b");
}

TEST(MmmModel, WarnsOfADamagedSegmentLength) {
  Warnings warnings;
  const KinematicModel read = ParseMmmModel(
      Model("<Transform><Translation x='0' y='0' z='120'/></Transform><Joint type='prismatic'>"
            "<translationdirection x='0' y='0' z='1'/><limits lo='0' hi='60' units='mm'/></Joint>"),
      "m.xml", &warnings);
  ASSERT_EQ(warnings.all().size(), 1u);
  EXPECT_THAT(warnings.texts()[0],
              AllOf(HasSubstr("m.xml:3: node 'arm'"), HasSubstr("120 mm"), HasSubstr("60 mm")));
}

TEST(MmmModel, WarnsOfWhatItLeavesOut) {
  Warnings warnings;
  const KinematicModel read = ParseMmmModel(
      Model(
          "",
          "<RobotNode name='loose'/><RobotNodeSet name='S'>\n<Node name='none'/><Node name='arm'/>"
          "</RobotNodeSet>"),
      "m.xml", &warnings);
  EXPECT_THAT(warnings.texts(),
              ElementsAre(HasSubstr("m.xml:4: node 'loose' is not connected with the root"),
                          HasSubstr("m.xml:5: node set 'S': 'none' is not a node")));
  EXPECT_EQ(read.segments().size(), 2u);
  EXPECT_THAT(read.node_sets().at("S"), ElementsAre("arm"));
}

TEST(MmmModel, RefusesWhatIsNoTree) {
  EXPECT_THAT(
      ErrorOf(Model("<Child name='hand'/>")),
      HasSubstr("m.xml:3: node 'arm' has a child 'hand', but there is no such <RobotNode>"));
  EXPECT_THAT(ErrorOf(Model("", "<RobotNode name='arm'/>")),
              HasSubstr("m.xml:4: node 'arm' is there twice; the first is in line 3"));
  EXPECT_THAT(ErrorOf(Model("", "<RobotNode name='x'><Child name='arm'/></RobotNode>")),
              HasSubstr("m.xml:4: node 'arm' is a child of both 'root_joint' and 'x'"));
  EXPECT_THAT(ErrorOf(Model("<Child name='root_joint'/>")), HasSubstr("is its own ancestor"));
  EXPECT_THAT(ErrorOf(Model("<Child name='arm'/>")),
              HasSubstr("m.xml:3: node 'arm' is a child of both"));
  EXPECT_THAT(ErrorOf(Model("",
                            "<RobotNode name='x'><Child name='y'/></RobotNode>\n"
                            "<RobotNode name='y'><Child name='x'/></RobotNode>")),
              HasSubstr("is its own ancestor: the children form a circle"));
  EXPECT_THAT(ErrorOf("<Robot RootNode='nobody'><RobotNode name='a'/></Robot>"),
              HasSubstr("m.xml:1: there is no node 'nobody'"));
  EXPECT_THAT(ErrorOf("<Robot><RobotNode name='a'/><RobotNode name='b'/></Robot>"),
              HasSubstr("several nodes are nobody's child"));
  EXPECT_THAT(ErrorOf("<Robot><RobotNode name='a'><Child name='a'/></RobotNode></Robot>"),
              HasSubstr("circle"));
  EXPECT_THAT(ErrorOf("<Robot/>"), HasSubstr("m.xml:1: the model has no <RobotNode>"));
  EXPECT_THAT(ErrorOf("<Robot><RobotNode/></Robot>"), HasSubstr("needs an attribute name"));
}

TEST(MmmModel, RefusesWhatMayNotStandAboveTheRoot) {
  const std::string rest =
      "<Child name='root_joint'/></RobotNode><RobotNode name='root_joint'/></Robot>";
  const std::string top = "<Robot RootNode='top'><RobotNode name='top'>";
  EXPECT_THAT(ErrorOf(top + "<Transform><Translation x='0' y='0' z='1'/></Transform>" + rest),
              HasSubstr("m.xml:1: node 'top' stands above the floating root 'root_joint'"));
  EXPECT_THAT(ErrorOf(top +
                      "<Joint type='revolute'><axis x='1' y='0' z='0'/><limits lo='0' hi='1'/>"
                      "</Joint>" +
                      rest),
              HasSubstr("node 'top' stands above"));
  EXPECT_THAT(
      ErrorOf(
          "<Robot RootNode='top'><RobotNode name='top'/><RobotNode name='root_joint'/></Robot>"),
      HasSubstr("node 'root_joint' is not connected with the RootNode 'top'"));
  EXPECT_THAT(
      ErrorOf("<Robot><RobotNode name='root_joint'><Joint type='revolute'>"
              "<axis x='1' y='0' z='0'/><limits lo='0' hi='1'/></Joint></RobotNode></Robot>"),
      HasSubstr("node 'root_joint' is the floating root and can't be a joint"));
}

TEST(MmmModel, RefusesImpossibleNumbers) {
  const auto joint = [](const std::string& limits) {
    return Model("<Joint type='revolute'><axis x='1' y='0' z='0'/>\n<limits " + limits +
                 "/></Joint>");
  };
  EXPECT_THAT(
      ErrorOf(joint("lo='1' hi='-1'")),
      HasSubstr("m.xml:4: node 'arm': the limits are crossed: lo=\"1\" is above hi=\"-1\""));
  EXPECT_THAT(ErrorOf(joint("lo='-90' hi='90'")), HasSubstr("check their unit"));
  EXPECT_THAT(ErrorOf(joint("lo='nan' hi='1'")),
              HasSubstr("<limits lo=\"nan\">: expected a finite"));
  EXPECT_THAT(ErrorOf(joint("lo='0' hi='1e999'")),
              HasSubstr("<limits hi=\"1e999\">: expected a finite"));
  EXPECT_THAT(ErrorOf(joint("hi='1'")), HasSubstr("<limits> needs an attribute lo="));
  // What is missing counts as 0, which crosses the limit that is there.
  EXPECT_THAT(ErrorOf(joint("hi='-1'")), HasSubstr("m.xml:4: node 'arm': <limits> needs an "
                                                   "attribute lo="));
  EXPECT_THAT(ErrorOf(Model("<Joint type='revolute'><axis x='0' y='0' z='0'/>\n<Limits lo='1'/>"
                            "</Joint>")),
              AllOf(HasSubstr("m.xml:3: node 'arm': <axis> has no direction\n"),
                    HasSubstr("m.xml:4: node 'arm': <Limits> needs an attribute hi=")));
  EXPECT_THAT(ErrorOf(joint("lo='0' hi='1' unit='mm'")),
              HasSubstr("<limits unit=\"mm\">: unknown unit; use degree or radian"));
  EXPECT_THAT(ErrorOf(Model("<Transform><Translation x='0' y='0' z='88000'/></Transform>")),
              HasSubstr("<Translation> is 88 m long"));
  EXPECT_THAT(ErrorOf(Model("<Transform><Translation x='0' y='0' z='1' unit='inch'/></Transform>")),
              HasSubstr("use mm, cm or m"));
  EXPECT_THAT(ErrorOf(Model("<Transform><DH a='1'/></Transform>")),
              HasSubstr("<DH> is not supported"));
  EXPECT_THAT(ErrorOf(Model("<Transform><Matrix4x4><row1 c1='2' c2='0' c3='0' c4='0'/></Matrix4x4>"
                            "</Transform>")),
              AllOf(HasSubstr("needs a <row2>"), HasSubstr("is not a rotation")));
  EXPECT_THAT(ErrorOf(Model("<Joint type='ball'/>")),
              HasSubstr("<Joint type=\"ball\">: unknown type"));
  EXPECT_THAT(ErrorOf(Model("<Joint type='revolute'/>")),
              AllOf(HasSubstr("needs an <axis"), HasSubstr("needs <limits")));
  EXPECT_THAT(
      ErrorOf(Model("<Joint type='prismatic'><translationdirection x='0' y='0' z='0'/></Joint>")),
      HasSubstr("has no direction"));
  EXPECT_THAT(ErrorOf(Model("<Physics><Mass value='-1'/></Physics>")),
              HasSubstr("-1 kg is outside 0"));
  EXPECT_THAT(
      ErrorOf(Model("<Physics><InertiaMatrix><row1 c1='1' c2='5' c3='0'/><row2 c1='0' c2='1' "
                    "c3='0'/><row3 c1='0' c2='0' c3='1'/></InertiaMatrix></Physics>")),
      HasSubstr("must be symmetric"));
}

TEST(MmmModel, CollectsAllErrorsOfAFile) {
  const std::string errors =
      ErrorOf(Model("\n<Joint type='ball'/>\n<Physics><Mass value='x'/></Physics>"
                    "\n<Child name='hand'/>"));
  EXPECT_THAT(errors,
              AllOf(HasSubstr("m.xml:4: "), HasSubstr("m.xml:5: "), HasSubstr("m.xml:6: ")));
}

TEST(MmmModel, RefusesOtherFiles) {
  EXPECT_THAT(ErrorOf("<MMM version='2.0'/>"),
              HasSubstr("m.xml:1: not a model: expected <Robot>, found <MMM>; this is a motion"));
  EXPECT_THAT(ErrorOf("not XML"), HasSubstr("m.xml:"));
  EXPECT_THAT(ErrorOf(""), Not(HasSubstr("no error")));
  EXPECT_THROW(ReadMmmModel(testing::TestFolder() + "/no_such_model.xml"), Error);
}

TEST(MmmModel, SurvivesALongChain) {
  std::string xml = "<Robot>";
  for (int i = 0; i < 20000; ++i) {
    xml += "<RobotNode name='" + std::to_string(i) + "'><Child name='" + std::to_string(i + 1) +
           "'/></RobotNode>";
  }
  const std::string end = "<RobotNode name='20000'/></Robot>";
  EXPECT_EQ(ParseMmmModel(xml + end, "m.xml").segments().size(), 20001u);
  EXPECT_THAT(ErrorOf(xml + "<RobotNode name='20000'><Child name='0'/></RobotNode></Robot>"),
              HasSubstr("circle"));
}

}  // namespace
}  // namespace mmm_converter
