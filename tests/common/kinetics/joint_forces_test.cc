// SPDX-License-Identifier: MIT
#include "common/kinetics/joint_forces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/kinetics/inverse_dynamics.h"
#include "common/kinetics/joint_forces_table.h"
#include "common/model/forward_kinematics.h"
#include "common/support/units.h"
#include "tests/common/kinetics/made_walker.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;

constexpr double kRate = 100, kSampleRate = 1000;
constexpr int kFrames = 200;
constexpr double kMass = 54;  // of the made person
constexpr double kWeight = kMass * kStandardGravity;

class JointForcesTest : public ::testing::Test {
 protected:
  static PoseTrajectory Standing(const KinematicModel& model) {
    PoseTrajectory motion;
    motion.rate = kRate;
    for (int j = 0; j < model.num_joints(); ++j) motion.joint_names.push_back(model.joint(j).name);
    Posture posture = ZeroPosture(model);
    posture.position.z() = 0.9;
    motion.postures.assign(kFrames, posture);
    return motion;
  }

  /// Bears that at (x, y) all the time.
  static PlateForces Plate(int number, double x, double y, double load) {
    constexpr auto kSamples = static_cast<Eigen::Index>(kFrames / kRate * kSampleRate);
    PlateForces plate;
    plate.plate.number = number;
    plate.plate.p_WP = {x, y, 0};
    plate.force = Eigen::Vector3d(0, 0, load).replicate(1, kSamples);
    plate.cop = Eigen::Vector3d(x + 0.02, y, 0).replicate(1, kSamples);
    plate.free_moment = Eigen::Matrix3Xd::Zero(3, kSamples);
    const Eigen::Vector3d arm(0.02, 0, 0);
    plate.moment = arm.cross(plate.force.col(0)).replicate(1, kSamples);
    plate.loads = {{0, static_cast<int>(kSamples)}};
    return plate;
  }

  JointForcesTest() {
    forces_.rate = kSampleRate;
    forces_.samples_per_frame = 10;
    forces_.plates = {Plate(1, 0, 0.1, kWeight / 2), Plate(2, 0, -0.1, kWeight / 2)};
    for (std::size_t i = 0; i < 2; ++i) {
      PlateLoad load;
      load.plate = i;
      load.samples = forces_.plates[i].loads[0];
      load.end = kFrames / kRate;
      load.bearer = i == 0 ? Bearer::kLeft : Bearer::kRight;
      contacts_.loads.push_back(load);
      contacts_.contacts.push_back({kSides[i], {}, {}, 0, 0, {static_cast<int>(i) + 1}});
    }
  }

  JointForces Compute() const {
    return ComputeJointForces(model_, Standing(model_), contacts_, forces_);
  }
  static Eigen::VectorXd Of(const JointForces& found, const std::string& name) {
    const auto at = std::find(found.names.begin(), found.names.end(), name);
    EXPECT_NE(at, found.names.end());
    return found.forces.row(at - found.names.begin()).transpose();
  }

  static constexpr int kMiddle = kFrames / 2;
  KinematicModel model_ = testing::MadePerson();
  RecordedForces forces_;
  Contacts contacts_;
};

TEST_F(JointForcesTest, StandingOnTwoPlates) {
  const JointForces found = Compute();
  EXPECT_EQ(found.mass, kMass);
  // The centre of pressure lies 20 mm before the ankle: the ankle's moment about -y holds it, less
  // what nothing else weighs there; the masses of the leg are right above.
  const double moment = kWeight / 2 * 0.02;
  for (const char* joint : {"calcn_l", "calcn_r", "knee_l", "knee_r", "hip_l", "hip_r"}) {
    EXPECT_NEAR(Of(found, joint)[kMiddle], -moment, 1e-9) << joint;
  }
  const Residuals residuals = MeasureResiduals(found);
  EXPECT_LT(residuals.force.peak, 1e-6);
  EXPECT_NEAR(residuals.moment.peak, 2 * moment, 1e-6);  // of a body that stands 20 mm off
  EXPECT_NEAR(residuals.external, kWeight, 1e-6);
  EXPECT_EQ(found.unmeasured_frames, 0);
  // The first and the last period of the low-pass are not settled.
  EXPECT_TRUE(std::isnan(Of(found, "hip_l")[16]));
  EXPECT_TRUE(std::isfinite(Of(found, "hip_l")[17]));
  EXPECT_TRUE(std::isnan(Of(found, "hip_l")[kFrames - 17]));
}

TEST_F(JointForcesTest, AFootOffThePlatesTakesItsLegOnly) {
  contacts_.loads.pop_back();
  contacts_.contacts[1].plates.clear();
  const JointForces found = Compute();
  EXPECT_TRUE(Of(found, "hip_r").array().isNaN().all());
  EXPECT_TRUE(Of(found, "toes_r").array().isNaN().all());
  EXPECT_TRUE(std::isfinite(Of(found, "hip_l")[kMiddle]));
  EXPECT_EQ(MeasureResiduals(found).frames, 0);
  EXPECT_FALSE(MeasureResiduals(found).is_within);
  const auto json = nlohmann::json::parse(FormatJointForcesJson(found));
  EXPECT_TRUE(json["residuals"].is_null());
  EXPECT_TRUE(json["legs"].back()["largest"].is_null());
}

TEST_F(JointForcesTest, WeightThatNoPlateBearsIsOnAFootThatWasTakenForLifted) {
  contacts_.loads.pop_back();
  contacts_.contacts.pop_back();
  const JointForces found = Compute();
  EXPECT_GT(found.unmeasured_frames, kFrames - 20);
  EXPECT_TRUE(Of(found, "hip_r").array().isNaN().all());
  EXPECT_TRUE(std::isfinite(Of(found, "hip_l")[kMiddle]));
}

TEST_F(JointForcesTest, BothFeetOnAPlateTellNeither) {
  contacts_.loads[1].bearer = Bearer::kBoth;
  const JointForces found = Compute();
  EXPECT_TRUE(Of(found, "hip_l").array().isNaN().all());
  EXPECT_TRUE(Of(found, "hip_r").array().isNaN().all());
}

TEST_F(JointForcesTest, AFootPartlyBesideItsPlateTellsNotItsLeg) {
  contacts_.loads[1].is_part_of_foot = true;
  // It stood before the load.
  contacts_.loads[1].begin += 0.2;
  const JointForces found = Compute();
  EXPECT_TRUE(std::isfinite(Of(found, "hip_l")[kMiddle]));
  EXPECT_TRUE(Of(found, "hip_r").array().isNaN().all());
}

TEST_F(JointForcesTest, ASampleWithoutANumberIsNoNumber) {
  forces_.plates[0].force(2, 1000) = kNaN;
  const JointForces found = Compute();
  EXPECT_TRUE(Of(found, "hip_l").array().isNaN().all());
  EXPECT_NEAR(Of(found, "hip_r")[kMiddle], -kWeight / 2 * 0.02, 1e-9);
}

TEST_F(JointForcesTest, Tables) {
  const JointForces found = Compute();
  const std::string csv = Join(FormatJointForcesCsv(found));
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time_s,hip_l_Nm,knee_l_Nm,calcn_l_Nm,toes_l_Nm,hip_r_Nm,knee_r_Nm,calcn_r_Nm,"
            "toes_r_Nm,residual_fx_N,residual_fy_N,residual_fz_N,residual_mx_Nm,residual_my_Nm,"
            "residual_mz_Nm");
  EXPECT_THAT(csv.substr(0, 400), HasSubstr("\n0,,,,,,,,,,,,,,\n"));
  // OpenSim takes no rows that are not known: the table begins with the first that are.
  const std::string sto = Join(FormatJointForcesSto(found));
  const std::size_t names = sto.find("time\thip_l_moment\tknee_l_moment");
  ASSERT_NE(names, std::string::npos);
  EXPECT_EQ(sto.find("nan"), std::string::npos);
  int begin = 0;
  while (!std::isfinite(Of(found, "hip_l")[begin])) ++begin;
  ASSERT_GT(begin, 0);
  const std::string first_row = sto.substr(sto.find('\n', names) + 1);
  EXPECT_DOUBLE_EQ(std::stod(first_row), found.time(begin));
  const auto rows = std::count(first_row.begin(), first_row.end(), '\n');
  EXPECT_THAT(sto, HasSubstr("nRows=" + std::to_string(rows) + "\n"));
  const auto json = nlohmann::json::parse(FormatJointForcesJson(found));
  EXPECT_NEAR(json["legs"][0]["largest"].get<double>(), -kWeight / 2 * 0.02 / kMass, 1e-5);
  EXPECT_EQ(json["residuals"]["verdict"], "beyond limits");  // of moments
}

TEST_F(JointForcesTest, ABodyWithoutMassHasNone) {
  ModelDescription description = DescriptionOf(model_);
  for (Segment& one : description.segments) one.mass = 0;
  model_ = KinematicModel(description);
  EXPECT_ANY_THROW(Compute());
}

}  // namespace
}  // namespace mmm_converter
