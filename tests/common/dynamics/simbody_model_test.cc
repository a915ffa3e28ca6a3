// SPDX-License-Identifier: MIT
// Simbody as an independent oracle: it shares no code with our kinematics.
#include "common/dynamics/simbody_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"
#include "tests/common/dynamics/test_bodies.h"
#include "tests/support/random_posture.h"
#include "tests/support/shared_data.h"
#include "tests/support/whole_body_inertia.h"

namespace mmm_converter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Chains of some 20 rotations on lengths of up to 4 m: rounding stays below 1e-13.
constexpr double kModelRounding = 1e-12;

void ExpectSimbodyAgrees(const KinematicModel& model) {
  const SimbodyModel simbody(model);
  SeededRandom random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Posture posture = testing::RandomPosture(model, random);
    const WholeBodyState oracle = simbody.At(posture);
    const std::vector<Eigen::Isometry3d> X_WS = SegmentPoses(model, posture);
    ASSERT_EQ(oracle.X_WS.size(), X_WS.size());
    for (std::size_t i = 0; i < X_WS.size(); ++i) {
      ASSERT_LT((X_WS[i].matrix() - oracle.X_WS[i].matrix()).norm(), kModelRounding)
          << model.segments()[i].name;
    }
    ASSERT_LT((MarkerPositions(model, posture) - oracle.p_WM).colwise().norm().maxCoeff(),
              kModelRounding);
    EXPECT_NEAR(oracle.mass, model.total_mass(), kModelRounding * model.total_mass());
    EXPECT_LT((CenterOfMass(model, posture) - oracle.center_of_mass).norm(), kModelRounding);
    const Eigen::Matrix3d inertia = testing::WholeBodyInertia(model, posture);
    EXPECT_LT((inertia - oracle.central_inertia).norm(), 1e-11 * inertia.norm());
  }
}

TEST(SimbodyModel, AgreesOnTheReferenceModel) {
  const KinematicModel read = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  ExpectSimbodyAgrees(read);
  ExpectSimbodyAgrees(ScaleWinter(read, {1.75, 70, 0.2}));
}

TEST(SimbodyModel, AgreesOnJointsThatFollowOthers) { ExpectSimbodyAgrees(testing::CoupledChain()); }

TEST(SimbodyModelRealFiles, AgreesOnRealModels) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  for (const char* file : {"mmm/models/mmm_2014_82nodes_52markers.xml",
                           "mmm/models/mmm_v2.2_133nodes_53markers.xml"}) {
    SCOPED_TRACE(file);
    ExpectSimbodyAgrees(ReadMmmModel(testing::SharedData(file)));
  }
}

TEST(SimbodyModel, HasNoCenterOfMassWithoutMass) {
  ModelDescription description;
  description.segments.resize(1);
  description.segments[0].name = "root";
  const KinematicModel model(description);
  const WholeBodyState state = SimbodyModel(model).At(ZeroPosture(model));
  EXPECT_EQ(state.mass, 0);
  EXPECT_TRUE(std::isnan(state.center_of_mass.x()));
}

TEST(SimbodyModel, RefusesAnImpossibleInertia) {
  ModelDescription description;
  description.segments.resize(1);
  description.segments[0].name = "root";
  description.segments[0].mass = 1;
  description.segments[0].inertia = Eigen::Vector3d(1, 1, 5).asDiagonal();  // no body has this
  EXPECT_THAT([&] { SimbodyModel{KinematicModel(description)}; },
              ThrowsMessage<Error>(HasSubstr("node 'root': no body has its inertia")));
}

}  // namespace
}  // namespace mmm_converter
