// SPDX-License-Identifier: MIT
#include "common/io/tables/trajectory_csv.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/math/rotation.h"

namespace mmm_converter {
namespace {

PoseTrajectory TwoFrames() {
  PoseTrajectory trajectory;
  trajectory.rate = 100;
  trajectory.first_time = 0.5;
  trajectory.joint_names = {"LKx_joint", "RKx_joint"};
  Posture q;
  q.position = {0.001, -0.0125, 1.0};
  q.orientation = Eigen::Quaterniond(RotationFromRpy({0.25, 0, 3.125}));
  q.joint_angles = Eigen::Vector2d(-0.5, 0);
  trajectory.postures.push_back(q);
  // Turned on through pi: yaw goes on, too.
  q.orientation = Eigen::Quaterniond(RotationFromRpy({0.25, 0, 3.25}));
  trajectory.postures.push_back(q);
  return trajectory;
}

TEST(TrajectoryCsvTest, NamesUnitsAndWritesWhatIsThere) {
  EXPECT_EQ(Join(FormatTrajectoryCsv(TwoFrames())),
            "time_s,root_x_mm,root_y_mm,root_z_mm,root_roll_rad,root_pitch_rad,root_yaw_rad,"
            "LKx_joint_rad,RKx_joint_rad\n"
            "0.5,1,-12.5,1000,0.25,0,3.125,-0.5,0\n"
            "0.51,1,-12.5,1000,0.25,0,3.25,-0.5,0\n");
}

TEST(TrajectoryCsvTest, NamesHaveAsManyCellsAsRows) {
  PoseTrajectory trajectory = TwoFrames();
  trajectory.joint_names = {"knee, left", "knee; left"};
  const std::string csv = Join(FormatTrajectoryCsv(trajectory));
  EXPECT_NE(csv.find("knee__left_rad,knee__left_2_rad\n"), std::string::npos) << csv;
}

TEST(TrajectoryCsvTest, StandardDeviationsStandBehindWithEmptyCellsWhereUnknown) {
  PoseTrajectory trajectory = TwoFrames();
  trajectory.postures.resize(1);
  trajectory.standard_deviations.resize(8, 1);
  trajectory.standard_deviations << 0.001, 0.002, 0.003, 0.01, 0.02, 0.03, 0.125,
      std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Join(FormatTrajectoryCsv(trajectory)),
            "time_s,root_x_mm,root_y_mm,root_z_mm,root_roll_rad,root_pitch_rad,root_yaw_rad,"
            "LKx_joint_rad,RKx_joint_rad,sd_root_x_mm,sd_root_y_mm,sd_root_z_mm,"
            "sd_root_about_x_rad,sd_root_about_y_rad,sd_root_about_z_rad,sd_LKx_joint_rad,"
            "sd_RKx_joint_rad\n"
            "0.5,1,-12.5,1000,0.25,0,3.125,-0.5,0,1,2,3,0.01,0.02,0.03,0.125,\n");
}

TEST(TrajectoryCsvTest, DerivativesStandLast) {
  PoseTrajectory trajectory = TwoFrames();
  trajectory.postures.resize(1);
  trajectory.joint_names = {"LKx_joint"};
  trajectory.postures[0].joint_angles = Eigen::VectorXd::Constant(1, -0.5);
  trajectory.velocities.resize(7, 1);
  trajectory.velocities << 0.001, 0.002, 0.003, 0.01, 0.02, 0.03, 0.125;
  trajectory.accelerations = 10 * trajectory.velocities;
  EXPECT_EQ(Join(FormatTrajectoryCsv(trajectory)),
            "time_s,root_x_mm,root_y_mm,root_z_mm,root_roll_rad,root_pitch_rad,root_yaw_rad,"
            "LKx_joint_rad,d_root_x_mm_per_s,d_root_y_mm_per_s,d_root_z_mm_per_s,"
            "d_root_about_x_rad_per_s,d_root_about_y_rad_per_s,d_root_about_z_rad_per_s,"
            "d_LKx_joint_rad_per_s,dd_root_x_mm_per_s2,dd_root_y_mm_per_s2,dd_root_z_mm_per_s2,"
            "dd_root_about_x_rad_per_s2,dd_root_about_y_rad_per_s2,dd_root_about_z_rad_per_s2,"
            "dd_LKx_joint_rad_per_s2\n"
            "0.5,1,-12.5,1000,0.25,0,3.125,-0.5,1,2,3,0.01,0.02,0.03,0.125,10,20,30,0.1,0.2,0.3,"
            "1.25\n");
}

}  // namespace
}  // namespace mmm_converter
