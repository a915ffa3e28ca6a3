// SPDX-License-Identifier: MIT
#include "common/io/tables/points_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/tables/qtm_tsv.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kRows =
    "0.00,1,2,3,4,5,6,7,8,9\n0.01,1,2,3,,,,7,8,9.5\n0.02,1,2,3,4,5,6,7,8,9\n";

void ExpectThreePoints(const std::string& content, const std::string& unit) {
  SCOPED_TRACE(content);
  ASSERT_TRUE(LooksLikePointsCsv(content));
  const MarkerTable table = ParsePointsCsv(content, "a.csv", nullptr);
  EXPECT_THAT(table.markers.labels(), ElementsAre("LASI", "RASI", "C7"));
  ASSERT_EQ(table.markers.num_frames(), 3);
  EXPECT_NEAR(table.markers.rate(), 100, 1e-9);
  EXPECT_EQ(table.markers.frame(0).col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_FALSE(IsSeen(table.markers.frame(1).col(1)));
  EXPECT_EQ(table.markers.frame(1)(2, 2), 9.5);
  EXPECT_EQ(table.unit, unit);
}

TEST(PointsCsv, NamesStandOverTheirCoordinatesInOneRowOrTwo) {
  const std::string rows = kRows;
  ExpectThreePoints("time,LASI_x,LASI_y,LASI_z,RASI_x,RASI_y,RASI_z,C7_x,C7_y,C7_z\n" + rows, "");
  ExpectThreePoints("Time (s),LASI.X,LASI.Y,LASI.Z,RASI.X,RASI.Y,RASI.Z,C7.X,C7.Y,C7.Z\n" + rows,
                    "");
  ExpectThreePoints(
      "time,LASI_x_mm,LASI_y_mm,LASI_z_mm,RASI_x_mm,RASI_y_mm,RASI_z_mm,C7_x_mm,"
      "C7_y_mm,C7_z_mm\n" +
          rows,
      "mm");
  ExpectThreePoints(
      "t,LASI_X (m),LASI_Y (m),LASI_Z (m),RASI_X (m),RASI_Y (m),RASI_Z (m),C7_X (m),"
      "C7_Y (m),C7_Z (m)\n" +
          rows,
      "m");
  ExpectThreePoints(
      "Time,LASI[0],LASI[1],LASI[2],RASI[0],RASI[1],RASI[2],C7[0],C7[1],C7[2]\n" + rows, "");
  ExpectThreePoints("time,LASI,,,RASI,,,C7,,\n,x,y,z,x,y,z,x,y,z\n" + rows, "");
  ExpectThreePoints(
      "time,LASI,LASI,LASI,RASI,RASI,RASI,C7,C7,C7\n,X1,Y1,Z1,X2,Y2,Z2,X3,Y3,Z3\n" + rows, "");
  // As data frames with two levels of columns are written.
  ExpectThreePoints(
      ",LASI,LASI,LASI,RASI,RASI,RASI,C7,C7,C7\n,x,y,z,x,y,z,x,y,z\ntime,,,,,,,,,\n" + rows, "");
}

TEST(PointsCsv, OtherTablesAreNone) {
  for (const char* content :
       {"", "time,a,b\n1,2,3\n", "frame,time\n", "time,A_x,A_y,A_z,B_x,B_y,B_z\n0,1,2,3,4,5,6\n",
        "time,1_ground_force_vx,1_ground_force_vy,1_ground_force_vz,1_ground_force_px\n",
        "a_x,a_y,a_z,b_x,b_y,b_z,c_x,c_y,c_z,q1,q2,q3,q4,q5,q6\n0\n", "x,y,z,x,y,z,x,y,z\n"}) {
    EXPECT_FALSE(LooksLikePointsCsv(content)) << content;
  }
  EXPECT_THAT([] { ParsePointsCsv("time,a\n", "a.csv", nullptr); },
              ThrowsMessage<Error>(HasSubstr("a.csv: ")));
  EXPECT_THAT([] { ParsePointsCsv("t,A_x,A_y,A_z,B_x,B_y,B_z,C_x,C_y,C_z\n", "a.csv", nullptr); },
              ThrowsMessage<Error>(HasSubstr("without rows of data")));
}

TEST(QtmTsv, AnExportOfForcesIsNamedAsSuch) {
  const std::string content =
      "NO_OF_SAMPLES\t2\nFREQUENCY\t1000\nFORCE_PLATE_NAME\tKistler\nForce_X\tForce_Y\n1\t2\n";
  ASSERT_TRUE(LooksLikeQtmTsv(content));
  EXPECT_THAT([&] { ParseQtmTsv(content, "a_f_1.tsv", nullptr); },
              ThrowsMessage<Error>(HasSubstr("a_f_1.tsv: an export of force plates by QTM")));
}

}  // namespace
}  // namespace mmm_converter
