// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_scaling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/io/osim/osim_model_reader.h"
#include "common/model/coordinate_map.h"
#include "common/model/forward_kinematics.h"
#include "common/support/error.h"
#include "tests/support/osim_texts.h"

namespace mmm_converter {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

OsimDocument ReadDocument(const std::string& content) {
  Diagnostics diagnostics("m.osim");
  return ParseOsim(content, {}, &diagnostics);
}

/// The numbers of all elements of that name, in order.
std::vector<double> NumbersOf(const std::string& text, const std::string& name) {
  std::vector<double> numbers;
  const std::string tag = "<" + name + ">";
  for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1)) {
    numbers.push_back(std::stod(text.substr(at + tag.size())));
  }
  return numbers;
}

/// Two muscles beside what nobody reads: one along moving and conditional points, one that wraps.
std::string WithMuscles(const std::string& model) {
  const std::string point = "<socket_parent_frame>/bodyset/";
  const std::string forces =
      "<Odd-One here='1'>  <!-- stays -->\n <x:y>0.30 </x:y></Odd-One>\n<ForceSet><objects>"
      "<Millard2012EquilibriumMuscle name=\"a\"><GeometryPath name=\"path\"><PathPointSet><objects>"
      "<PathPoint>" +
      point +
      "pelvis</socket_parent_frame><location>0.01 0.02 0.03</location>"
      "</PathPoint><ConditionalPathPoint>" +
      point +
      "pelvis</socket_parent_frame>"
      "<location>0.5 0.5 0.5</location><socket_coordinate>/jointset/knee/knee_angle"
      "</socket_coordinate><range>0 1</range></ConditionalPathPoint><MovingPathPoint>" +
      point +
      "pelvis</socket_parent_frame><location>9 9 9</location><x_location><LinearFunction>"
      "<coefficients>-0.1 0.05</coefficients></LinearFunction></x_location><y_location><Constant>"
      "<value>0.02</value></Constant></y_location><SimmSpline name=\"z_location\"><x>-1 -0.3 1</x>"
      "<y>0.2 0.13 0.7</y></SimmSpline><socket_x_coordinate>/jointset/knee/knee_angle"
      "</socket_x_coordinate><socket_y_coordinate>/jointset/knee/knee_angle</socket_y_coordinate>"
      "<socket_z_coordinate>/jointset/knee/knee_angle</socket_z_coordinate></MovingPathPoint>"
      "</objects></PathPointSet></GeometryPath><optimal_fiber_length>0.06</optimal_fiber_length>"
      "<tendon_slack_length>0.2</tendon_slack_length></Millard2012EquilibriumMuscle>"
      "<Thelen2003Muscle name=\"b\"><GeometryPath><PathPointSet><objects><PathPoint>" +
      point + "pelvis</socket_parent_frame><location>0 0 0</location></PathPoint><PathPoint>" +
      point +
      "pelvis</socket_parent_frame><location>0 0.1 0</location></PathPoint></objects>"
      "</PathPointSet><PathWrapSet><objects><PathWrap/></objects></PathWrapSet></GeometryPath>"
      "<optimal_fiber_length>0.05</optimal_fiber_length></Thelen2003Muscle></objects></ForceSet>";
  std::string text = model;
  text.insert(text.find("<MarkerSet"), forces);
  return text;
}

OsimScaling ScaleAll(double factor) {
  OsimScaling scaling;
  for (const OsimBody& body : ReadDocument(testing::OsimOfAllKinds()).bodies) {
    scaling.factors[body.name] = Vector3d::Constant(factor);
  }
  return scaling;
}

TEST(OsimScaling, NothingToScaleIsNothingChanged) {
  const std::string text = WithMuscles(testing::OsimOfAllKinds()) + "\n</Odd> behind the end";
  EXPECT_TRUE(ScaleOsim(text, "m.osim", ScaleAll(1), nullptr) == text);
}

// Twice as large a body at the same angles: twice as far is every marker from the ground's origin
// but for the joint on the ground, which keeps its place there.
TEST(OsimScaling, AllBodiesAlikeMakeALargerModel) {
  const std::string text = testing::OsimOfAllKinds();
  const double factor = 1.25;
  const KinematicModel before = ParseOsimModel(text, "m.osim");
  const KinematicModel after =
      ParseOsimModel(ScaleOsim(text, "m.osim", ScaleAll(factor), nullptr), "m.osim");
  const auto& all = before.coordinates()->coordinates();
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::VectorXd small(static_cast<Eigen::Index>(all.size()));
    for (Eigen::Index i = 0; i < small.size(); ++i)
      small[i] = all[i].rest + 0.1 * std::sin(i + trial);
    Eigen::VectorXd large = small;
    for (Eigen::Index i = 0; i < large.size(); ++i) {
      const bool is_length = all[i].kind == ModelCoordinate::Kind::kShift && all[i].name != "ty";
      if (is_length) large[i] *= factor;
    }
    const Eigen::Matrix3Xd p = MarkerPositions(before, PostureOf(before, small));
    const Eigen::Matrix3Xd P = MarkerPositions(after, PostureOf(after, large));
    const int pelvis = before.FindMarker("pelvis1");
    for (Eigen::Index m = 0; m < p.cols(); ++m) {
      // A shift by 1 m for each radian is left alone, as OpenSim leaves it.
      if (before.markers()[m].name.starts_with("patella")) continue;
      const double distance = (p.col(m) - p.col(pelvis)).norm();
      EXPECT_NEAR((P.col(m) - P.col(pelvis)).norm(), factor * distance, 1e-12)
          << before.markers()[m].name;
    }
  }
}

TEST(OsimScaling, MassesAndInertias) {
  const std::string text = testing::OsimOfAllKinds();
  OsimScaling scaling;
  scaling.factors["thigh"] = {2, 2, 2};
  scaling.factors["shank"] = {1, 3, 2};
  scaling.mass = 24;  // of 12 bodies of 1 kg
  const auto bodies = [&] {
    return ReadDocument(ScaleOsim(text, "m.osim", scaling, nullptr)).bodies;
  };
  const std::vector<OsimBody> kept = bodies();
  Eigen::Matrix3d I;
  I << 0.01, 0.001, 0, 0.001, 0.02, 0, 0, 0, 0.03;
  EXPECT_EQ(kept[2].name, "thigh");
  EXPECT_DOUBLE_EQ(kept[2].mass, 2);
  EXPECT_TRUE(kept[2].inertia.isApprox(8 * I, 1e-14));
  EXPECT_TRUE(kept[2].p_BC.isApprox(Vector3d(0, 0.2, 0)));
  EXPECT_TRUE(kept[1].inertia.isApprox(2 * I, 1e-14));
  // A cylinder along x: radius^2 = 0.02, length^2 = 3 (0.02 - 0.005) = 0.045, of 1 kg.
  EXPECT_EQ(kept[3].name, "shank");
  EXPECT_NEAR(kept[3].inertia(0, 0), 2 * 0.5 * 0.02 * 6, 1e-15);
  EXPECT_NEAR(kept[3].inertia(1, 1), 2 * (0.045 / 3 + 0.02 * 6 / 4), 1e-15);
  EXPECT_NEAR(kept[3].inertia(2, 2), kept[3].inertia(1, 1), 1e-15);
  EXPECT_NEAR(kept[3].inertia(0, 1), 2 * 0.001 * 3, 1e-15);
  scaling.keeps_mass_distribution = false;  // 10 + 8 + 6 kg
  const std::vector<OsimBody> by_volume = bodies();
  EXPECT_NEAR(by_volume[1].mass, 1, 1e-14);
  EXPECT_NEAR(by_volume[2].mass, 8, 1e-14);
  EXPECT_NEAR(by_volume[3].mass, 6, 1e-14);
  EXPECT_TRUE(by_volume[2].inertia.isApprox(32 * I, 1e-14));
}

TEST(OsimScaling, MusclesGoWithTheirPaths) {
  const std::string text = WithMuscles(testing::OsimOfAllKinds());
  OsimScaling scaling;
  scaling.factors["pelvis"] = {1, 1, 3};
  Warnings warnings;
  const std::string scaled = ScaleOsim(text, "m.osim", scaling, &warnings);
  // At -0.3 rad from (0.01, 0.02, 0.03) to (0.08, 0.02, 0.13), past the point that is not active.
  const double ratio = std::hypot(0.07, 0.3) / std::hypot(0.07, 0.1);
  const std::vector<double> fibres = NumbersOf(scaled, "optimal_fiber_length");
  ASSERT_EQ(fibres.size(), 2U);
  EXPECT_NEAR(fibres[0], 0.06 * ratio, 1e-14);
  EXPECT_EQ(fibres[1], 0.05);
  EXPECT_NEAR(NumbersOf(scaled, "tendon_slack_length").front(), 0.2 * ratio, 1e-14);
  EXPECT_TRUE(warnings.empty());  // the one that wraps keeps its length
  EXPECT_THAT(scaled, HasSubstr("<Odd-One here='1'>  <!-- stays -->\n <x:y>0.30 </x:y></Odd-One>"));
  scaling.factors["pelvis"] = {1, 2, 1};
  ScaleOsim(text, "m.osim", scaling, &warnings);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("although it wraps: b")));
}

TEST(OsimScaling, WrapsAndWhatIsDrawnGoWithTheirBody) {
  std::string text = testing::OsimOfAllKinds();
  text.insert(text.find("<mass>"),
              "<attached_geometry><Mesh><scale_factors>1 2 1</scale_factors></Mesh>"
              "</attached_geometry><WrapObjectSet><objects><WrapCylinder><xyz_body_rotation>"
              "1.5707963267948966 0 0</xyz_body_rotation><translation>1 1 1</translation>"
              "<radius>0.1</radius><length>0.5</length></WrapCylinder><WrapEllipsoid><dimensions>"
              "1 1 1</dimensions></WrapEllipsoid></objects></WrapObjectSet>");
  OsimScaling scaling;
  scaling.factors["pelvis"] = {2, 3, 4};
  const std::string scaled = ScaleOsim(text, "m.osim", scaling, nullptr);
  EXPECT_THAT(scaled, HasSubstr("<scale_factors>2 6 4</scale_factors>"));
  EXPECT_THAT(scaled, HasSubstr("<translation>2 3 4</translation>"));
  EXPECT_THAT(scaled, HasSubstr("<dimensions>2 3 4</dimensions>"));
  EXPECT_NEAR(NumbersOf(scaled, "length").front(), 1.5, 1e-14);  // its z is the body's y
  EXPECT_NEAR(NumbersOf(scaled, "radius").front(), 0.3, 1e-14);
}

TEST(OsimScaling, MarkersAreAddedAndMoved) {
  for (const char* empty : {"<MarkerSet name=\"markerset\"><objects>\n</objects></MarkerSet>",
                            "<MarkerSet name=\"markerset\"><objects /></MarkerSet>",
                            "<MarkerSet name=\"markerset\"/>", ""}) {
    std::string text = testing::OsimText(testing::OsimBodyText("a"),
                                         testing::OsimJointText("PinJoint", "j", "ground", "a"));
    const std::string set = "<MarkerSet name=\"markerset\"><objects>\n</objects></MarkerSet>";
    text.replace(text.find(set), set.size(), empty);
    const OsimDocument document = ReadDocument(text);
    const std::vector<OsimMarker> markers = {{"x & y", 0, 1, {0.1, 0.2, 0.3}, true},
                                             {"z", 0, 0, {1, 2, 3}, false}};
    std::string written = WriteOsimMarkers(text, "m.osim", document, markers);
    written = WriteOsimMarkers(written, "m.osim", document, {{"z", 0, 1, {3, 2, 1}, false}});
    const std::vector<OsimMarker> read = ReadDocument(written).markers;
    ASSERT_EQ(read.size(), 2U) << empty;
    EXPECT_EQ(read[0].name, "x & y");
    EXPECT_EQ(read[0].p_BM, Vector3d(0.1, 0.2, 0.3));
    EXPECT_TRUE(read[0].is_fixed);
    EXPECT_EQ(read[1].body, 1);
    EXPECT_EQ(read[1].p_BM, Vector3d(3, 2, 1));
    EXPECT_FALSE(read[1].is_fixed);
    EXPECT_TRUE(WriteOsimMarkers(written, "m.osim", document, read) == written);
  }
}

TEST(OsimScaling, ABodyMustBeThereAndKeepASize) {
  for (const auto& [body, factors, what] : {std::tuple("thihg", Vector3d(1, 1, 2), "no such body"),
                                            {"thigh", Vector3d(1, 0, 2), "larger than zero"},
                                            {"thigh", Vector3d(1, NAN, 2), "larger than zero"}}) {
    OsimScaling scaling;
    scaling.factors[body] = factors;
    try {
      ScaleOsim(testing::OsimOfAllKinds(), "m.osim", scaling, nullptr);
      FAIL();
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(what));
    }
  }
}

// Cut anywhere it is no model; with bytes that are others it is one, or an error tells.
TEST(OsimScaling, DamagedFilesAreErrors) {
  const std::string text = WithMuscles(testing::OsimOfAllKinds());
  for (std::size_t size = 0; size < text.size() - 30; size += 211) {
    EXPECT_THROW(ScaleOsim(text.substr(0, size), "m.osim", ScaleAll(1.1), nullptr), Error) << size;
  }
  int scaled = 0;
  for (std::size_t at = 100; at < text.size(); at += 173) {
    std::string damaged = text;
    damaged[at] = "<>/\"x0-"[at % 7];
    try {
      ScaleOsim(damaged, "m.osim", ScaleAll(1.1), nullptr);
      ++scaled;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("m.osim"));
    }
  }
  EXPECT_GT(scaled, 5);
}

TEST(OsimScaling, ASetInAnotherFileIsRefused) {
  std::string text = testing::OsimOfAllKinds();
  text.insert(text.find("<MarkerSet"), "<ForceSet file=\"forces.xml\"/>");
  try {
    ScaleOsim(text, "m.osim", ScaleAll(1), nullptr);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("<ForceSet> stands in another file, forces.xml"));
  }
}

}  // namespace
}  // namespace mmm_converter
