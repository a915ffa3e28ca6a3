// SPDX-License-Identifier: MIT
// Real files, against what other implementations stored.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/forces/plate_forces.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

class RealForcesTest : public ::testing::Test {
 protected:
  void SetUp() override { MMM_CONVERTER_NEEDS_SHARED_DATA(); }

  static RecordedForces Read(const std::string& file) {
    return ReadForces(testing::SharedData(file), nullptr);
  }
};

/// The numbers behind `endheader` and the line of names, a row for each line.
std::vector<std::vector<double>> StorageRows(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line) && line != "endheader") {
  }
  std::getline(file, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::istringstream numbers(line);
    std::vector<double> row;
    for (double number = 0; numbers >> number;) row.push_back(number);
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

TEST_F(RealForcesTest, AreThoseThatOpenSimStored) {
  const RecordedForces forces = Read("forces/walking2.c3d");
  const auto rows = StorageRows(testing::SharedData("forces/std_cop_walking2_grfs.sto"));
  ASSERT_EQ(rows.size(), 101U);
  ASSERT_EQ(forces.plates.size(), 2U);
  for (const std::vector<double>& row : rows) {
    const auto sample = std::lround(row[0] * forces.rate);
    for (std::size_t i = 0; i < 2; ++i) {
      const PlateForces& plate = forces.plates[i];
      const Eigen::Map<const Eigen::Matrix3d> stored(row.data() + 1 + 9 * i);  // f, p, m
      EXPECT_LT((plate.force.col(sample) - stored.col(0)).norm(), 1e-3);
      EXPECT_LT((1e3 * plate.cop.col(sample) - stored.col(1)).norm(), 1e-2) << row[0];
      EXPECT_LT((1e3 * plate.free_moment.col(sample) - stored.col(2)).norm(), 1e-2);
    }
  }
}

TEST_F(RealForcesTest, LoadsOfTheWalk) {
  const RecordedForces forces = Read("forces/walking2.c3d");
  const auto time = [&](int sample) { return sample / forces.rate; };
  ASSERT_EQ(forces.plates[1].loads.size(), 1U);
  EXPECT_NEAR(time(forces.plates[1].loads[0].begin), 2.248, 0.005);
  EXPECT_NEAR(time(forces.plates[1].loads[0].end), 2.760, 0.005);
  ASSERT_EQ(forces.plates[0].loads.size(), 1U);
  EXPECT_NEAR(time(forces.plates[0].loads[0].begin), 2.672, 0.005);
  EXPECT_NEAR(time(forces.plates[0].loads[0].end), 3.249, 0.005);
}

TEST_F(RealForcesTest, APlateOfEightForces) {
  const RecordedForces forces = Read("forces/FP_Type3.c3d");
  const PlateForces& plate = forces.plates.at(0);
  const Eigen::Vector3d stored(1.87, -2.86, 886.40);
  EXPECT_LT((plate.force.col(0) - stored).cwiseAbs().maxCoeff(), 0.75);
  EXPECT_LT((1e3 * plate.cop.col(0) - Eigen::Vector3d(446.65, 291.15, -5.75)).norm(), 0.06);
}

TEST_F(RealForcesTest, TwoCalibrationsOfATrial) {
  const Eigen::Vector3d moments_force(-1.0, -4.4, 229.1);
  const Eigen::Vector3d calibrated_force(-1.0, -4.9, 226.4);
  const RecordedForces moments = Read("forces/TYPE-2.C3D");
  const RecordedForces calibrated = Read("forces/TYPE-4.C3D");
  const auto sample = std::lround(1.2 * moments.rate);
  EXPECT_LT((moments.plates.at(0).force.col(sample) - moments_force).norm(), 0.1);
  EXPECT_LT((calibrated.plates.at(0).force.col(sample) - calibrated_force).norm(), 0.1);
  EXPECT_LT(
      (1e3 * moments.plates[0].cop.col(sample).head<2>() - Eigen::Vector2d(293.6, 247.6)).norm(),
      0.1);
  EXPECT_LT(
      (1e3 * calibrated.plates[0].cop.col(sample).head<2>() - Eigen::Vector2d(306.3, 244.0)).norm(),
      0.1);
}

TEST_F(RealForcesTest, TheSameTrialInThreeEncodings) {
  const RecordedForces integers = Read("recordings/conformance/Eb015pi.c3d");
  for (const char* file :
       {"recordings/conformance/Eb015pr.c3d", "recordings/conformance/Eb015si.c3d"}) {
    const RecordedForces other = Read(file);
    ASSERT_EQ(other.plates.size(), integers.plates.size());
    for (std::size_t i = 0; i < other.plates.size(); ++i) {
      // Floats of 4 bytes, of forces of a kilonewton.
      EXPECT_LT((other.plates[i].force - integers.plates[i].force).cwiseAbs().maxCoeff(), 1e-3);
      ASSERT_EQ(other.plates[i].loads.size(), integers.plates[i].loads.size());
      for (std::size_t k = 0; k < other.plates[i].loads.size(); ++k) {
        EXPECT_EQ(other.plates[i].loads[k].begin, integers.plates[i].loads[k].begin);
        EXPECT_EQ(other.plates[i].loads[k].end, integers.plates[i].loads[k].end);
      }
    }
  }
}

}  // namespace
}  // namespace mmm_converter
