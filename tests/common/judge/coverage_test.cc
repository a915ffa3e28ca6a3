// SPDX-License-Identifier: MIT
#include "common/judge/coverage.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/model/posture.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> ShownBy(const std::vector<std::string>& markers) {
  const KinematicModel model = testing::ScaledReferenceModel(1.75);
  std::vector<MarkerAssignment> assignments;
  for (const std::string& name : markers) {
    const int marker = model.FindMarker("MARKER_" + name);
    EXPECT_GE(marker, 0) << name;
    assignments.push_back({LabelIx(static_cast<int>(assignments.size())), MarkerIx(marker), 1});
  }
  const TrackingSetup setup = testing::SetupOf(model, testing::TrackedJoints(model), assignments);
  PoseTrajectory motion;
  motion.rate = 100;
  for (const int joint : setup.joints) motion.joint_names.push_back(model.joint(joint).name);
  Posture posture = ZeroPosture(model);
  posture.joint_angles = posture.joint_angles(setup.joints).eval();
  motion.postures = {posture, posture};
  const AnatomicalAngles angles = ShownAngles(setup, motion);
  EXPECT_EQ(angles.values.rows(), static_cast<Eigen::Index>(angles.angles.size()));
  EXPECT_EQ(angles.num_frames(), 2);
  std::vector<std::string> names;
  for (const AnatomicalAngle& one : angles.angles) {
    names.push_back(fmt::format("{} {} {}", one.joint, one.side, one.motion));
  }
  return names;
}

TEST(CoverageTest, AnglesThatNoMarkerTellsAreNotShown) {
  const std::vector<std::string> leg =
      ShownBy({"C7", "CLAV", "STRN", "T10", "LASI", "RASI", "LKNE", "LANK", "LHEE"});
  EXPECT_THAT(
      leg, AllOf(Contains("pelvis  tilt"), Contains("trunk  flexion"), Contains("hip left flexion"),
                 Contains("knee left flexion"), Contains("ankle left dorsiflexion")));
  EXPECT_THAT(leg, AllOf(Not(Contains(StartsWith("neck"))), Not(Contains(StartsWith("wrist"))),
                         Not(Contains(StartsWith("shoulder"))), Not(Contains(HasSubstr("right"))),
                         Not(Contains("ankle left inversion"))));
  const std::vector<std::string> foot =
      ShownBy({"LASI", "RASI", "STRN", "LKNE", "LANK", "LHEE", "LTOE", "LMT1", "LMT5"});
  EXPECT_THAT(foot, Contains("ankle left inversion"));
}

}  // namespace
}  // namespace mmm_converter
