// SPDX-License-Identifier: MIT
#include "common/judge/limb_places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kLimbFrames = 10;

class LimbPlacesTest : public ::testing::Test {
 protected:
  LimbPlacesTest()
      : model_(std::make_shared<KinematicModel>(
            ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")))),
        joints_(testing::TrackedJoints(*model_)) {}

  /// Of a person who wears these markers and is in that posture all the time, `far` from them [m].
  std::vector<std::string> Judge(const std::vector<std::string>& markers, const std::string& joint,
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
    ConversionResult result;
    result.trajectory.postures.assign(kLimbFrames, posture);
    result.residuals =
        Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(markers.size()), kLimbFrames, far);
    const MarkerSequence recording(markers, kLimbFrames, 100, 0);
    VerdictReasons reasons;
    JudgeLimbPlaces(setup, LimbsOf(setup), recording, result, &reasons);
    return reasons.Conclude().reasons;
  }

  std::shared_ptr<const KinematicModel> model_;
  std::vector<int> joints_;
};

const std::vector<std::string> kTrunkAndLegs = {"C7",   "CLAV", "STRN", "T10",  "LASI", "RASI",
                                                "LKNE", "LANK", "LHEE", "LTOE", "LMT1", "LMT5"};

TEST_F(LimbPlacesTest, ALegBesideTheTrunkIsNamed) {
  EXPECT_THAT(Judge(kTrunkAndLegs, "LHx_joint", 0), IsEmpty());
  EXPECT_THAT(Judge(kTrunkAndLegs, "LHx_joint", 1.57), IsEmpty());  // sits with straight legs
  // On an arm that hangs down, by two labels.
  EXPECT_THAT(Judge({"C7", "CLAV", "STRN", "T10", "RMT1", "RMT5"}, "RHx_joint", 1.57),
              ElementsAre(HasSubstr("the right leg lies beside the trunk")));
}

TEST_F(LimbPlacesTest, AKneeThatWouldBendBackwardsIsNamed) {
  EXPECT_THAT(Judge(kTrunkAndLegs, "", 0, 0.05), IsEmpty());
  EXPECT_THAT(Judge(kTrunkAndLegs, "LKx_joint", -0.5, 0.12), IsEmpty());
  EXPECT_THAT(Judge(kTrunkAndLegs, "", 0, 0.12),
              ElementsAre(HasSubstr("the left leg would bend backwards at the knee")));
}

}  // namespace
}  // namespace mmm_converter
