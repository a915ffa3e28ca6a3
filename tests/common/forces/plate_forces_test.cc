// SPDX-License-Identifier: MIT
#include "common/forces/plate_forces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/forces/plate_checks.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// What rounding leaves of forces of a kilonewton.
constexpr double kExact = 1e-9;

/// A plate of 0.4 x 0.6 m that stands turned and tilted somewhere.
ForcePlate TurnedPlate(PlateType type) {
  ForcePlate plate;
  plate.type = type;
  plate.channels = {0, 1, 2, 3, 4, 5};
  plate.R_WP = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  plate.p_WP = {0.3, -0.2, 0.1};
  plate.half_size = {0.2, 0.3};
  plate.origin = {0.004, -0.002, -0.04};
  plate.file_unit = 1e-3;
  plate.moment_unit = 1e-3;
  return plate;
}

const Eigen::Vector3d kForce(30, -50, -700);  // in P: z is down
const Eigen::Vector2d kPressure(0.05, -0.12);
constexpr double kFreeMoment = 4;

/// About the middle of the surface, in P.
Eigen::Vector3d SurfaceMoment() {
  const Eigen::Vector3d cop(kPressure.x(), kPressure.y(), 0);
  return cop.cross(kForce) + Eigen::Vector3d(0, 0, kFreeMoment);
}

void ExpectWrench(const PlateForces& forces) {
  const ForcePlate& plate = forces.plate;
  const Eigen::Vector3d cop =
      plate.p_WP + plate.R_WP * Eigen::Vector3d(kPressure.x(), kPressure.y(), 0);
  EXPECT_LT((forces.force.col(0) - plate.R_WP * kForce).norm(), kExact);
  EXPECT_LT((forces.cop.col(0) - cop).norm(), kExact);
  EXPECT_LT((forces.free_moment.col(0) - plate.R_WP * Eigen::Vector3d(0, 0, kFreeMoment)).norm(),
            kExact);
  const Eigen::Vector3d about_middle =
      (cop - plate.p_WP).cross(forces.force.col(0)) + forces.free_moment.col(0);
  EXPECT_LT((forces.moment.col(0) - about_middle).norm(), kExact);
}

TEST(PlateForcesTest, ForcesAndCop) {
  Eigen::VectorXd channels(6);
  channels << kForce, 1e3 * kPressure, 1e3 * kFreeMoment;
  ExpectWrench(ForcesOfPlate(TurnedPlate(PlateType::kForcesAndCop), channels));
}

TEST(PlateForcesTest, ForcesAndMoments) {
  const ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  const Eigen::Vector3d at_sensors = SurfaceMoment() - kForce.cross(plate.origin);
  Eigen::VectorXd channels(6);
  channels << kForce, 1e3 * at_sensors;
  ExpectWrench(ForcesOfPlate(plate, channels));
}

TEST(PlateForcesTest, CalibrationIsReadByColumns) {
  ForcePlate plate = TurnedPlate(PlateType::kCalibratedChannels);
  Eigen::Matrix<double, 6, 6> calibration = Eigen::Matrix<double, 6, 6>::Identity();
  calibration(0, 4) = 0.25;
  calibration(5, 1) = -2;
  plate.calibration = calibration;
  const Eigen::Vector3d at_sensors = SurfaceMoment() - kForce.cross(plate.origin);
  Eigen::VectorXd wanted(6);
  wanted << kForce, 1e3 * at_sensors;
  ExpectWrench(ForcesOfPlate(plate, calibration.inverse() * wanted));
}

TEST(PlateForcesTest, EightForces) {
  ForcePlate plate = TurnedPlate(PlateType::kEightForces);
  plate.origin = {0.12, 0.2, -0.05};
  const Eigen::Vector3d m = SurfaceMoment() - kForce.cross(Eigen::Vector3d(0, 0, plate.origin.z()));
  const double a = plate.origin.x();
  const double b = plate.origin.y();
  // Four sensors (+a, +b), (-a, +b), (-a, -b), (+a, -b) bear what gives force and moment.
  const double fz = kForce.z() / 4;
  const double by_x = m.x() / (4 * b);
  const double by_y = m.y() / (4 * a);
  const double fx = m.z() / b;
  Eigen::VectorXd channels(8);
  channels << (kForce.x() - fx) / 2, (kForce.x() + fx) / 2, kForce.y() / 2, kForce.y() / 2,
      fz + by_x - by_y, fz + by_x + by_y, fz - by_x + by_y, fz - by_x - by_y;
  ExpectWrench(ForcesOfPlate(plate, channels));
}

TEST(PlateForcesTest, WithoutTheSensorsPlacesThereIsNoCentreOfPressure) {
  ForcePlate plate = TurnedPlate(PlateType::kEightForces);
  plate.has_moments = false;
  const PlateForces forces = ForcesOfPlate(plate, Eigen::VectorXd::Constant(8, -50));
  EXPECT_NEAR((plate.R_WP.transpose() * forces.force.col(0)).z(), -200, kExact);
  EXPECT_FALSE(forces.cop.col(0).allFinite());
}

TEST(PlateForcesTest, ASampleWithoutANumberHasNoForce) {
  const ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  Eigen::MatrixXd channels = Eigen::MatrixXd::Constant(6, 2, -100);
  channels(2, 1) = kNaN;
  const PlateForces forces = ForcesOfPlate(plate, channels);
  EXPECT_TRUE(forces.force.col(0).allFinite());
  EXPECT_FALSE(forces.force.col(1).allFinite());
  EXPECT_FALSE(forces.cop.col(1).allFinite());
}

/// A plate that lies level, and what its vertical channel measures over time [N, z down].
class PlateLoadsTest : public ::testing::Test {
 protected:
  static constexpr double kRate = 1000;

  PlateForces Judge(const Eigen::VectorXd& vertical) {
    ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
    plate.R_WP = Eigen::Vector3d(1, -1, -1).asDiagonal();
    plate.origin.setZero();
    Eigen::MatrixXd channels = Eigen::MatrixXd::Zero(6, vertical.size());
    channels.row(2) = vertical;
    PlateForces forces = ForcesOfPlate(plate, channels);
    JudgeLoads(kRate, &forces, &warnings);
    return forces;
  }

  /// 1 s, somebody of 700 N on the plate in [300, 700) ms.
  static Eigen::VectorXd Step(double offset) {
    Eigen::VectorXd vertical = Eigen::VectorXd::Constant(1000, offset);
    vertical.segment(300, 400).array() -= 700;
    return vertical;
  }

  Warnings warnings;
};

TEST_F(PlateLoadsTest, AStep) {
  const PlateForces forces = Judge(Step(0));
  ASSERT_THAT(forces.loads, SizeIs(1));
  EXPECT_EQ(forces.loads[0].begin, 300);
  EXPECT_EQ(forces.loads[0].end, 700);
  EXPECT_EQ(forces.largest_load, 700);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(PlateLoadsTest, ContactsAreCountedFromTheUnloadedLevel) {
  const PlateForces forces = Judge(Step(30));
  ASSERT_THAT(forces.loads, SizeIs(1));
  EXPECT_EQ(forces.unloaded_level, -30);
  EXPECT_EQ(forces.largest_load, 700);
  ASSERT_THAT(warnings.texts(), SizeIs(1));
  EXPECT_THAT(warnings.texts()[0], HasSubstr("force plate 1: -30 N while nobody is on it"));
}

TEST_F(PlateLoadsTest, ForcesOnThePlateAreReversed) {
  const PlateForces forces = Judge(-Step(0));
  EXPECT_TRUE(forces.is_reversed);
  ASSERT_THAT(forces.loads, SizeIs(1));
  EXPECT_EQ(forces.Load(500), 700);
  EXPECT_THAT(warnings.texts()[0], HasSubstr("every load points down"));
}

TEST_F(PlateLoadsTest, ForcesDownThatAreNeverAbsentTellNoContact) {
  const PlateForces forces = Judge(Eigen::VectorXd::Constant(1000, 900));
  EXPECT_FALSE(forces.tells_contact);
  EXPECT_FALSE(forces.is_seen_unloaded);
  EXPECT_TRUE(forces.loads.empty());
}

TEST_F(PlateLoadsTest, ShortGapsAreClosedAndShortLoadsDropped) {
  Eigen::VectorXd vertical = Step(0);
  vertical.segment(500, 20).setZero();
  vertical.segment(100, 30).setConstant(-300);
  EXPECT_THAT(Judge(vertical).loads, SizeIs(1));
}

TEST_F(PlateLoadsTest, AMomentThatNeverChangesTellsNoCentreOfPressure) {
  ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  plate.R_WP = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Eigen::MatrixXd channels = Eigen::MatrixXd::Zero(6, 1000);
  channels.row(2) = Step(0);
  channels.row(3) = Eigen::VectorXd::LinSpaced(1000, 0, 5000);
  channels.row(4).setConstant(3276.8);
  PlateForces forces = ForcesOfPlate(plate, channels);
  JudgeLoads(kRate, &forces, &warnings);
  ASSERT_TRUE(forces.cop.col(500).allFinite());
  LeaveOutSaturated(channels, &forces, &warnings);
  EXPECT_FALSE(forces.cop.col(500).allFinite());
  EXPECT_THAT(warnings.texts()[0], HasSubstr("its moment My never changes"));
}

TEST_F(PlateLoadsTest, AHorizontalForceThatNeverChangesTellsNoMoments) {
  ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  plate.R_WP = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Eigen::MatrixXd channels = Eigen::MatrixXd::Random(6, 1000);
  channels.row(2) += Step(0).transpose();
  EXPECT_THAT(StillShears(plate, channels), IsEmpty());
  channels.row(1).setConstant(0.3);
  EXPECT_THAT(StillShears(plate, channels), ElementsAre(1));
  PlateForces forces = ForcesOfPlate(plate, channels);
  JudgeLoads(kRate, &forces, nullptr);
  LeaveOutStill({1}, &forces, &warnings);
  EXPECT_FALSE(forces.moment.col(500).allFinite());
  EXPECT_TRUE(forces.cop.col(500).allFinite());
  EXPECT_THAT(warnings.texts(),
              ElementsAre(HasSubstr("force plate 1: its horizontal force Fy, channel ")));
  // Nobody is there.
  forces.loads.clear();
  LeaveOutStill({1}, &forces, &warnings);
  EXPECT_THAT(warnings.texts(), SizeIs(1));
}

TEST_F(PlateLoadsTest, NothingIsMeasuredAfterTheRecorderStopped) {
  ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  plate.R_WP = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Eigen::MatrixXd channels = Eigen::MatrixXd::Random(6, 1000);
  channels.row(2) += Step(0).transpose();
  channels.rightCols(200).setZero();  // as an unloaded plate
  const Eigen::MatrixXd as_it_was = channels;
  LeaveOutStopped(kRate, 2, plate, &channels, &warnings);
  EXPECT_EQ(channels, as_it_was);
  channels.rightCols(200).colwise() = Eigen::VectorXd::Constant(6, 2887);
  LeaveOutStopped(kRate, 2, plate, &channels, &warnings);
  EXPECT_EQ(channels.leftCols(800), as_it_was.leftCols(800));
  EXPECT_TRUE(channels.rightCols(200).array().isNaN().all());
  EXPECT_THAT(warnings.texts(),
              ElementsAre(HasSubstr("changes from 2.80 s on, which makes -2887 N")));
  PlateForces forces = ForcesOfPlate(plate, channels);
  JudgeLoads(kRate, &forces, nullptr);
  EXPECT_TRUE(forces.tells_contact);
  EXPECT_THAT(forces.loads, SizeIs(1));
}

TEST_F(PlateLoadsTest, WhatAnUnloadedPlateShowsIsTakenAway) {
  ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  plate.origin.setZero();
  Eigen::MatrixXd stepped = Eigen::MatrixXd::Zero(6, 1000);
  stepped.row(2) = Step(0);
  for (const int row : {0, 2}) {
    Eigen::MatrixXd channels = stepped;
    channels.row(row).array() += 40;
    SubtractUnloaded(kRate, plate, &channels, &warnings);
    EXPECT_LT((channels - stepped).cwiseAbs().maxCoeff(), 1e-9) << row;
  }
  EXPECT_THAT(warnings.texts(), SizeIs(2));
  SubtractUnloaded(kRate, plate, &stepped, &warnings);
  EXPECT_THAT(warnings.texts(), SizeIs(2));
}

TEST_F(PlateLoadsTest, AFlatTopWithNoiseIsSaturated) {
  Eigen::VectorXd vertical = Step(0);
  vertical.segment(300, 10) = Eigen::VectorXd::LinSpaced(10, -50, -650);
  PlateForces forces = Judge(vertical);
  forces.channels = Eigen::MatrixXd::Zero(6, 1000);
  forces.channels.row(2) = vertical;
  for (int k = 310; k < 700; ++k) forces.channels(2, k) += k % 2 == 0 ? 0.3 : -0.3;
  FindClipped(kRate, 0, &forces, &warnings);
  ASSERT_THAT(forces.clipped, SizeIs(1));
  EXPECT_EQ(forces.clipped[0].begin, 310);
  EXPECT_EQ(forces.clipped[0].end, 700);
  EXPECT_THAT(warnings.texts().back(), HasSubstr("Fz is saturated"));
}

TEST_F(PlateLoadsTest, MomentsInAnotherUnitAreFound) {
  ForcePlate plate = TurnedPlate(PlateType::kForcesAndMoments);
  plate.R_WP = Eigen::Vector3d(1, -1, -1).asDiagonal();
  plate.origin.setZero();
  Eigen::MatrixXd channels = Eigen::MatrixXd::Zero(6, 1000);
  channels.row(2) = Step(0);
  channels.row(3) = 100 * channels.row(2);  // the pressure 0.1 m along y, in N mm
  plate.moment_unit = 1;
  CorrectUnits(channels, &plate, &warnings);
  EXPECT_EQ(plate.moment_unit, 1e-3);
  EXPECT_THAT(warnings.texts()[0], HasSubstr("taken so"));
}

}  // namespace
}  // namespace mmm_converter
