// SPDX-License-Identifier: MIT
#include "common/study/limb_places.h"

#include <gtest/gtest.h>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

constexpr int kLimbFrames = 10;

class LimbPlacesTest : public ::testing::Test {
 protected:
  LimbPlacesTest()
      : model_(std::make_shared<KinematicModel>(
            ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")))),
        joints_(testing::TrackedJoints(*model_)) {}

  /// Of a person who wears these markers and is in that posture all the time, `far` from them [m].
  std::vector<LimbPlace> Measure(const std::vector<std::string>& markers, const std::string& joint,
                                 double angle, double far = 0) const {
    TrackingSetup setup;
    setup.model = model_;
    setup.joints = joints_;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const int marker = model_->FindMarker("MARKER_" + markers[i]);
      EXPECT_GE(marker, 0) << markers[i];
      setup.mapping.assignments.push_back({LabelIx(static_cast<int>(i)), MarkerIx(marker), 1});
    }
    Posture posture = ZeroPosture(*model_);
    Eigen::VectorXd tracked = posture.joint_angles(joints_);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (model_->joint(joints_[j]).name == joint) tracked[static_cast<Eigen::Index>(j)] = angle;
    }
    posture.joint_angles = tracked;
    PoseTrajectory trajectory;
    trajectory.postures.assign(kLimbFrames, posture);
    return MeasureLimbPlaces(
        setup, LimbsOf(setup), MarkerSequence(markers, kLimbFrames, 100, 0), trajectory,
        Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(markers.size()), kLimbFrames, far));
  }

  std::shared_ptr<const KinematicModel> model_;
  std::vector<int> joints_;
};

const std::vector<std::string> kTrunkAndLegs = {"C7",   "CLAV", "STRN", "T10",  "LASI", "RASI",
                                                "LKNE", "LANK", "LHEE", "LTOE", "LMT1", "LMT5"};

TEST_F(LimbPlacesTest, ALegIsBesideTheTrunkWhereItsAnkleIsAboveTheHip) {
  const auto beside = [&](const std::vector<std::string>& markers, const char* joint,
                          double angle) {
    const std::vector<LimbPlace> places = Measure(markers, joint, angle);
    EXPECT_EQ(places.size(), 1u);
    EXPECT_TRUE(places.front().is_leg);
    return places.front().beside_trunk;
  };
  EXPECT_EQ(beside(kTrunkAndLegs, "LHx_joint", 0), 0);
  EXPECT_EQ(beside(kTrunkAndLegs, "LHx_joint", 1.57), 0);  // sits with straight legs
  // On an arm that hangs down, by two labels.
  EXPECT_EQ(beside({"C7", "CLAV", "STRN", "T10", "RMT1", "RMT5"}, "RHx_joint", 1.57), 1);
}

TEST_F(LimbPlacesTest, OnlyAStraightKneeWouldBendBackwards) {
  const std::vector<LimbPlace> straight = Measure(kTrunkAndLegs, "", 0, 0.12);
  ASSERT_EQ(straight.size(), 1u);
  EXPECT_EQ(straight.front().limb, "left leg");
  EXPECT_EQ(straight.front().bent_back, 0.12);
  EXPECT_EQ(Measure(kTrunkAndLegs, "LKx_joint", -0.5, 0.12).front().bent_back, 0);
}

}  // namespace
}  // namespace mmm_converter
