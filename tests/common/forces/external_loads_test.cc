// SPDX-License-Identifier: MIT
#include "common/forces/external_loads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/support/atomic_file.h"
#include "common/support/error.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::testing::SizeIs;
using testing::TestFolder;

class ExternalLoadsTest : public ::testing::Test {
 protected:
  static std::string Write(const std::string& name, const std::string& text) {
    const std::string file = TestFolder() + "/" + name;
    WriteFileAtomically(file, text);
    return file;
  }
  static std::string MessageOf(const std::string& file) {
    try {
      ReadExternalLoads(file, Eigen::Vector3d::UnitY(), nullptr);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(ExternalLoadsTest, WhatIsNoTableIsSaid) {
  EXPECT_THAT(MessageOf(Write("a.mot", "time x\n0 1\n")), ::testing::HasSubstr("endheader"));
  EXPECT_THAT(MessageOf(Write("b.mot", "endheader\ntime a b\n0 1 2\n1 2\n")),
              ::testing::HasSubstr("b.mot:4: 2 numbers, but 3 columns"));
  EXPECT_THAT(MessageOf(Write("c.mot", "endheader\ntime a\n0 1\n1 2\n")),
              ::testing::HasSubstr("has no force"));
  EXPECT_THAT(
      MessageOf(Write("d.mot", "endheader\ntime f_vx f_vy f_vz\n0 0 0 0\n1 0 0 0\n7 0 0 0\n")),
      ::testing::HasSubstr("not even"));
  EXPECT_THAT(MessageOf(Write("e.mot", "endheader\ntime f_vx\n0 0\n1 0\n")),
              ::testing::HasSubstr("x, y and z"));
  EXPECT_THAT(MessageOf(Write("f.xml", "<OpenSimDocument><ExternalLoads/></OpenSimDocument>")),
              ::testing::HasSubstr("names no datafile"));
}

TEST_F(ExternalLoadsTest, ColumnsAreTakenByTheirNames) {
  const std::string in_order = "endheader\ntime f_vx f_vy f_vz f_px f_py f_pz\n";
  const std::string mixed = "endheader\ntime f_vx f_px f_vz f_vy f_pz f_py\n";
  const RecordedForces a =
      ReadExternalLoads(Write("a.mot", in_order + "0 1 700 3 4 5 6\n0.01 1 700 3 4 5 6\n"),
                        Eigen::Vector3d::UnitY(), nullptr);
  const RecordedForces b =
      ReadExternalLoads(Write("b.mot", mixed + "0 1 4 3 700 6 5\n0.01 1 4 3 700 6 5\n"),
                        Eigen::Vector3d::UnitY(), nullptr);
  EXPECT_EQ(a.plates[0].force.col(0), Eigen::Vector3d(1, 700, 3));
  EXPECT_EQ(b.plates[0].force, a.plates[0].force);
  EXPECT_EQ(b.plates[0].cop, a.plates[0].cop);
  EXPECT_THAT(MessageOf(Write("c.mot",
                              "endheader\ntime f_vx f_vy f_vz f_px f_pz\n0 1 2 3 4 5\n"
                              "0.01 1 2 3 4 5\n")),
              ::testing::HasSubstr("c.mot: has a column f_px, but none f_py"));
}

TEST_F(ExternalLoadsTest, IdentifiersThatNoColumnHasAreErrors) {
  Write("t.mot",
        "endheader\ntime f_vz f_vx f_vy f_px f_py f_pz\n0 3 1 700 4 5 6\n"
        "0.01 3 1 700 4 5 6\n");
  const auto loads = [](const std::string& torque) {
    return Write("t.xml",
                 "<OpenSimDocument><ExternalLoads><objects><ExternalForce name='f'>"
                 "<force_identifier>f_v</force_identifier>"
                 "<point_identifier>f_p</point_identifier><torque_identifier>" +
                     torque +
                     "</torque_identifier></ExternalForce></objects>"
                     "<datafile>t.mot</datafile></ExternalLoads></OpenSimDocument>");
  };
  const RecordedForces forces =
      ReadExternalLoads(loads("Unassigned"), Eigen::Vector3d::UnitY(), nullptr);
  EXPECT_EQ(forces.plates[0].force.col(0), Eigen::Vector3d(1, 700, 3));
  EXPECT_THAT(MessageOf(loads("f_torque_")),
              ::testing::HasSubstr("\"f_torque_\" begins the names of 0 columns"));
}

TEST_F(ExternalLoadsTest, NumbersAndTimesHaveBounds) {
  const std::string names = "endheader\ntime f_vx f_vy f_vz\n";
  EXPECT_THAT(MessageOf(Write("a.mot", names + "0 1 2 3\n10000000 1 2 3\n")),
              ::testing::HasSubstr("a.mot: its rows are 1e+07 s apart"));
  EXPECT_THAT(MessageOf(Write("b.mot", names + "0 1 1e300 3\n0.01 1 2 3\n")),
              ::testing::HasSubstr("b.mot: f_v has numbers above 1e+06"));
}

TEST_F(ExternalLoadsTest, AForceWithoutAPointTellsNoCentreOfPressure) {
  Warnings warnings;
  const RecordedForces forces = ReadExternalLoads(
      Write("g.mot", "endheader\ntime\tf_vx\tf_vy\tf_vz\t\n0\t0\t700\t0\t\n0.01\t0\tnan\t0\t\n"),
      Eigen::Vector3d::UnitY(), &warnings);
  ASSERT_THAT(forces.plates, SizeIs(1));
  EXPECT_FALSE(forces.plates[0].cop.col(0).allFinite());
  EXPECT_FALSE(forces.plates[0].force.col(1).allFinite());
  EXPECT_FALSE(warnings.empty());
}

}  // namespace
}  // namespace mmm_converter
