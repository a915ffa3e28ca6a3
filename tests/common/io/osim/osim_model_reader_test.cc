// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_model_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "common/io/model_file.h"
#include "common/math/up_axis.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "tests/support/osim_texts.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::OsimAxisText;
using testing::OsimBodyText;
using testing::OsimCoordinateText;
using testing::OsimJointText;
using testing::OsimMarkerText;
using testing::OsimText;

// Chains of some ten turns and offsets below 1 m.
constexpr double kOsimRounding = 1e-14;

Eigen::Isometry3d Turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, axis.normalized()));
}

Eigen::Isometry3d Pose(const Eigen::Vector3d& p, const Eigen::Vector3d& xyz) {
  return Eigen::Translation3d(p) * Turn(xyz.x(), {1, 0, 0}) * Turn(xyz.y(), {0, 1, 0}) *
         Turn(xyz.z(), {0, 0, 1});
}

/// What OsimJointText puts around a joint's transform.
Eigen::Isometry3d BetweenFrames(const Eigen::Isometry3d& X_FM) {
  return Pose({0.1, -0.2, 0.05}, {0.3, -0.2, 0.1}) * X_FM *
         Pose({0.02, 0.15, -0.01}, {-0.1, 0.4, 0.2}).inverse();
}

/// The pose in ground of the body "b", which hangs on the ground by a joint of this type, where
/// its coordinates have these values.
Eigen::Isometry3d PoseOfBody(const std::string& type, const std::vector<double>& values,
                             const std::string& more = "") {
  const KinematicModel model = ParseOsimModel(
      OsimText(OsimBodyText("b"), OsimJointText(type, "j", "ground", "b", more)), "m.osim");
  const Eigen::VectorXd q = Eigen::VectorXd::Map(values.data(), values.size());
  const auto poses = SegmentPoses(model, PostureOf(model, q));
  return model.coordinates()->R_WG().transpose() * poses[model.FindSegment("b")];
}

void ExpectNear(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), kOsimRounding) << a.matrix() << "\n\n"
                                                                            << b.matrix();
}

TEST(OsimJoints, MoveAsOpenSimHasThem) {
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  ExpectNear(PoseOfBody("WeldJoint", {}), BetweenFrames(Eigen::Isometry3d::Identity()));
  ExpectNear(PoseOfBody("PinJoint", {0.4}), BetweenFrames(Turn(0.4, z)));
  ExpectNear(PoseOfBody("SliderJoint", {0.4}),
             BetweenFrames(Eigen::Isometry3d(Eigen::Translation3d(0.4, 0, 0))));
  ExpectNear(PoseOfBody("UniversalJoint", {0.4, -0.3}),
             BetweenFrames(Turn(0.4, x) * Turn(-0.3, y)));
  for (const char* type : {"GimbalJoint", "BallJoint"}) {
    ExpectNear(PoseOfBody(type, {0.4, -0.3, 0.2}),
               BetweenFrames(Turn(0.4, x) * Turn(-0.3, y) * Turn(0.2, z)));
  }
  ExpectNear(
      PoseOfBody("FreeJoint", {0.4, -0.3, 0.2, 1, 2, 3}),
      BetweenFrames(Eigen::Translation3d(1, 2, 3) * Turn(0.4, x) * Turn(-0.3, y) * Turn(0.2, z)));
  ExpectNear(PoseOfBody("PlanarJoint", {0.4, 1, 2}),
             BetweenFrames(Eigen::Translation3d(1, 2, 0) * Turn(0.4, z)));
}

TEST(OsimJoints, CustomAxesMayBeObliqueAndTheirFunctionsOfAnyCoordinate) {
  const std::string more =
      "<coordinates>" + OsimCoordinateText("b2") + OsimCoordinateText("a1") +
      "</coordinates><SpatialTransform>" +
      OsimAxisText("rotation1", "a1 b2", "0 2 1",
                   "<LinearFunction name=\"function\"><coefficients>0.5 -2 0.1</coefficients>"
                   "</LinearFunction>") +
      OsimAxisText("rotation2", "a1", "1 1 0",
                   "<function><PolynomialFunction><coefficients>0.3 0 0.2</coefficients>"
                   "</PolynomialFunction></function>") +
      OsimAxisText("rotation3", "b2", "0 0 1", "<function/>") +
      OsimAxisText("translation1", "", "1 0 0",
                   "<Constant name=\"function\"><value>0.03</value></Constant>") +
      OsimAxisText("translation3", "a1", "0 1 1",
                   "<MultiplierFunction name=\"function\"><LinearFunction name=\"function\">"
                   "<coefficients>2 1</coefficients></LinearFunction><scale>0.5</scale>"
                   "</MultiplierFunction>") +
      "</SpatialTransform>";
  const double a1 = 0.4, b2 = -0.3;  // in the order of their first use
  const Eigen::Vector3d shift =
      Eigen::Vector3d(0.03, 0, 0) + 0.5 * (2 * a1 + 1) * Eigen::Vector3d(0, 1, 1).normalized();
  ExpectNear(PoseOfBody("CustomJoint", {a1, b2}, more),
             BetweenFrames(Eigen::Translation3d(shift) * Turn(0.5 * a1 - 2 * b2 + 0.1, {0, 2, 1}) *
                           Turn(0.3 * a1 * a1 + 0.2, {1, 1, 0}) * Turn(b2, {0, 0, 1})));
}

TEST(OsimModel, OfBothLayoutsIsTheSame) {
  const std::string old =
      "<OpenSimDocument Version=\"20303\"><Model name=\"made\"><BodySet><objects>"
      "<Body name=\"ground\"><Joint/></Body>"
      "<Body name=\"b\"><mass>1</mass><mass_center> 0 0.1 0</mass_center>"
      "<inertia_xx>0.01</inertia_xx><inertia_yy>0.02</inertia_yy><inertia_zz>0.03</inertia_zz>"
      "<inertia_xy>1e-003</inertia_xy><Joint><PinJoint name=\"j\"><parent_body>ground"
      "</parent_body><location_in_parent>0.1\n-0.2\t0.05</location_in_parent>"
      "<orientation_in_parent>0.3 -0.2 0.1</orientation_in_parent>"
      "<location>0.02 0.15 -0.01</location><orientation>-0.1 0.4 0.2</orientation>"
      "<CoordinateSet><objects><Coordinate name=\"angle\"><clamped> True </clamped>"
      "<range>-1 2</range></Coordinate></objects></CoordinateSet></PinJoint></Joint></Body>"
      "</objects></BodySet><MarkerSet><objects><Marker name=\"m\"><body>b</body>"
      "<location>1 2 3</location></Marker></objects></MarkerSet></Model></OpenSimDocument>";
  const std::string now = OsimText(
      OsimBodyText("b"),
      OsimJointText("PinJoint", "j", "ground", "b",
                    "<coordinates>" +
                        OsimCoordinateText("angle", "<clamped>true</clamped><range>-1 2</range>") +
                        "</coordinates>"),
      "", OsimMarkerText("m", "b", "1 2 3"));
  const KinematicModel a = ParseOsimModel(old, "old.osim");
  const KinematicModel b = ParseOsimModel(now, "new.osim");
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, 0.7);
  EXPECT_EQ(MarkerPositions(a, PostureOf(a, q)), MarkerPositions(b, PostureOf(b, q)));
  EXPECT_EQ(a.segments().back().inertia, b.segments().back().inertia);
  EXPECT_EQ(a.joint(0).name, "angle");
  EXPECT_EQ(a.joint(0).lower, -1);
  EXPECT_EQ(a.joint(0).upper, 2);
  EXPECT_TRUE(a.is_root_fixed());
}

TEST(OsimModel, StandsUprightByItsGravity) {
  const std::string text =
      OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b"));
  EXPECT_TRUE(ParseOsimModel(text, "m.osim").coordinates()->R_WG() == RotationToZUp(UpAxis::kY));
  std::string z_up = text;
  z_up.insert(z_up.find("<Ground"), "<gravity>0 0 -9.81</gravity>");
  EXPECT_TRUE(ParseOsimModel(z_up, "m.osim").coordinates()->R_WG().isIdentity(0));
}

TEST(OsimModel, HasJointsForFreeCoordinatesOnly) {
  Warnings warnings;
  const KinematicModel model = ParseOsimModel(testing::OsimOfAllKinds(), "m.osim", "", &warnings);
  EXPECT_THAT(warnings.texts(), IsEmpty());
  EXPECT_FALSE(model.is_root_fixed());
  EXPECT_EQ(model.segments().front().name, "pelvis");
  EXPECT_EQ(model.FindJoint("mtp_angle"), -1);      // locked
  EXPECT_EQ(model.FindJoint("patella_angle"), -1);  // coupled
  EXPECT_EQ(model.FindJoint("tilt"), -1);           // of the root
  ASSERT_GE(model.FindJoint("knee_angle"), 0);
  const Segment& knee = model.joint(model.FindJoint("knee_angle"));
  EXPECT_EQ(knee.lower, -2.1);
  EXPECT_EQ(knee.upper, 0.2);
  EXPECT_EQ(knee.rest, -0.3);
  // Without clamping the range is not a limit: the default one, 10 to both sides, is more than a
  // turn.
  const Segment& hip = model.joint(model.FindJoint("hip_coord_1"));
  EXPECT_TRUE(HasNoLimits(hip));
  EXPECT_FALSE(IsEndless(hip));
  EXPECT_EQ(hip.reach, std::numbers::pi);
  EXPECT_EQ(model.joint(model.FindJoint("shoulder_coord_0")).type, JointType::kSliding);
}

TEST(OsimModel, CouplersAndLocksHold) {
  const KinematicModel model = ParseOsimModel(testing::OsimOfAllKinds(), "m.osim");
  const std::vector<ModelCoordinate>& all = model.coordinates()->coordinates();
  CoordinateSeries series(model);
  Posture posture = ZeroPosture(model);
  posture.joint_angles[model.FindJoint("knee_angle")] = -1;
  const Eigen::VectorXd values = series.Next(posture);
  std::map<std::string, double> by_name;
  for (std::size_t i = 0; i < all.size(); ++i) {
    by_name[all[i].name] = values[static_cast<Eigen::Index>(i)];
  }
  EXPECT_EQ(by_name.at("knee_angle"), -1);
  EXPECT_NEAR(by_name.at("patella_angle"), -0.7 * 0.8, kOsimRounding);
  EXPECT_EQ(by_name.at("mtp_angle"), 0.2);
}

TEST(OsimModel, ChainsOfCouplersMayStandInAnyOrder) {
  const auto coupler = [](const char* dependent, const char* leader) {
    return std::string("<CoordinateCouplerConstraint name=\"of ") + dependent +
           "\"><coupled_coordinates_function><LinearFunction><coefficients>2 0.1</coefficients>"
           "</LinearFunction></coupled_coordinates_function><independent_coordinate_names>" +
           leader + "</independent_coordinate_names><dependent_coordinate_name>" + dependent +
           "</dependent_coordinate_name></CoordinateCouplerConstraint>";
  };
  const std::string bodies = OsimBodyText("a") + OsimBodyText("b") + OsimBodyText("c");
  const std::string joints = OsimJointText("PinJoint", "j", "ground", "a") +
                             OsimJointText("PinJoint", "k", "a", "b") +
                             OsimJointText("PinJoint", "l", "b", "c");
  const KinematicModel model = ParseOsimModel(
      OsimText(bodies, joints,
               coupler("l_coord_0", "k_coord_0") + coupler("k_coord_0", "j_coord_0")),
      "m.osim");
  ASSERT_EQ(model.num_joints(), 1);
  Posture posture = ZeroPosture(model);
  posture.joint_angles[0] = 0.3;
  CoordinateSeries series(model);
  EXPECT_NEAR(series.Next(posture)[2], 2 * (2 * 0.3 + 0.1) + 0.1, kOsimRounding);
}

TEST(OsimModel, ReadsSetsAndMarkersFromOtherFiles) {
  const testing::TemporaryFolder folder;
  const std::string whole =
      OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b"), "",
               OsimMarkerText("m", "b", "1 2 3"));
  const auto begin = whole.find("<MarkerSet");
  const std::string set = whole.substr(begin, whole.find("</Model>") - begin);
  std::string parted = whole;
  parted.replace(begin, set.size(), "<MarkerSet file=\"markers.xml\"/>");
  std::ofstream(folder.path() + "/markers.xml")
      << "<OpenSimDocument Version=\"40000\">" << set << "</OpenSimDocument></Stray>";
  std::ofstream(folder.path() + "/m.osim") << parted;
  const KinematicModel model = ReadOsimModel(folder.path() + "/m.osim");
  ASSERT_EQ(model.markers().size(), 1U);
  EXPECT_EQ(model.markers()[0].p_SM, Eigen::Vector3d(1, 2, 3));

  std::ofstream(folder.path() + "/more.xml")
      << "<OpenSimDocument Version=\"20303\"><MarkerSet><objects><Marker name=\"m\"><body>b</body>"
         "<location>4 5 6</location></Marker><Marker name=\"n\"><body>b</body></Marker></objects>"
         "</MarkerSet></OpenSimDocument>";
  const KinematicModel more = ReadOsimModel(folder.path() + "/m.osim", folder.path() + "/more.xml");
  ASSERT_EQ(more.markers().size(), 2U);
  EXPECT_EQ(more.markers()[0].p_SM, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(ReadModelFile(folder.path() + "/m.osim", nullptr).model.markers().size(), 1U);
}

TEST(OsimModel, OffsetFramesMayHangOnOffsetFrames) {
  std::string text = OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b"), "",
                              "<Marker name=\"m\"><socket_parent_frame>/bodyset/b/in/deep"
                              "</socket_parent_frame><location>0 0 1</location></Marker>");
  const std::string frames =
      "<components><PhysicalOffsetFrame name=\"in\"><socket_parent>..</socket_parent>"
      "<translation>1 0 0</translation><orientation>0 0 1.5707963267948966</orientation>"
      "<components><PhysicalOffsetFrame name=\"deep\"><socket_parent>..</socket_parent>"
      "<translation>2 0 0</translation></PhysicalOffsetFrame></components></PhysicalOffsetFrame>"
      "</components>";
  text.insert(text.find("<mass>"), frames);
  const KinematicModel model = ParseOsimModel(text, "m.osim");
  EXPECT_LT((model.markers()[0].p_SM - Eigen::Vector3d(1, 2, 1)).norm(), kOsimRounding);
}

TEST(OsimModel, ToleratesWhatOpenSimTolerates) {
  std::string text = OsimText(OsimBodyText("b"), OsimJointText("PinJoint", "j", "ground", "b"));
  text.insert(text.find("<Ground"),
              "<credits>a \x96 b</credits><ForceSet><objects>"
              "<Schutte1993Muscle_Deprecated::x name=\"m\"/></objects>"
              "</ForceSet>");
  EXPECT_EQ(ParseOsimModel(text + "</OpenSimDocument>\n</Model> more", "m.osim").num_joints(), 1);
}

}  // namespace
}  // namespace mmm_converter
