// SPDX-License-Identifier: MIT
#include "common/study/coverage.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/model/posture.h"
#include "common/support/units.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kCoverageRate = 100;

TrackingSetup SetupWith(const std::vector<std::string>& markers) {
  const KinematicModel model = testing::ScaledReferenceModel(1.75);
  std::vector<MarkerAssignment> assignments;
  for (const std::string& name : markers) {
    const int marker = model.FindMarker("MARKER_" + name);
    EXPECT_GE(marker, 0) << name;
    assignments.push_back({LabelIx(static_cast<int>(assignments.size())), MarkerIx(marker), 1});
  }
  return testing::SetupOf(model, testing::TrackedJoints(model), assignments);
}

PoseTrajectory Standing(const TrackingSetup& setup, int frames) {
  PoseTrajectory motion;
  motion.rate = kCoverageRate;
  for (const int joint : setup.joints) motion.joint_names.push_back(setup.model->joint(joint).name);
  Posture posture = ZeroPosture(*setup.model);
  posture.joint_angles = posture.joint_angles(setup.joints).eval();
  motion.postures.assign(static_cast<std::size_t>(frames), posture);
  return motion;
}

std::vector<std::string> ShownBy(const std::vector<std::string>& markers) {
  const TrackingSetup setup = SetupWith(markers);
  const AnatomicalAngles angles = ShownAngles(setup, Standing(setup, 2));
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
      ShownBy({"C7", "CLAV", "STRN", "T10", "LASI", "RASI", "LKNE", "LHEE", "LTOE"});
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

// A heel and a malleolus are 70 mm apart, each 10 mm off.
TEST(CoverageTest, AFootWithoutItsFrontDoesNotTellHowItIsBent) {
  EXPECT_THAT(ShownBy({"LASI", "RASI", "STRN", "LKNE", "LANK", "LHEE"}),
              AllOf(Contains("knee left flexion"), Not(Contains(StartsWith("ankle")))));
  EXPECT_THAT(DescribeUnshown(SetupWith({"LASI", "RASI", "STRN", "LKNE", "LANK", "LHEE"})),
              HasSubstr("how the left foot is bent"));
}

/// Of a lower body, hidden from frame 100 on for so many.
struct PartlyHidden {
  TrackingSetup setup = SetupWith({"LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LANK", "LHEE",
                                   "LTOE", "RTHI", "RKNE", "RANK", "RHEE", "RTOE"});
  MarkerSequence recording;

  PartlyHidden(const std::vector<std::string>& hidden, int frames)
      : recording(LabelsOf(setup), 300, kCoverageRate, 0) {
    for (int k = 0; k < recording.num_frames(); ++k) {
      recording.frame(k).setZero();
      for (const std::string& label : hidden) {
        const auto& all = recording.labels();
        const auto at = std::find(all.begin(), all.end(), label) - all.begin();
        if (k >= 100 && k < 100 + frames) recording.frame(k).col(at).setConstant(kNaN);
      }
    }
  }

  static std::vector<std::string> LabelsOf(const TrackingSetup& setup) {
    std::vector<std::string> labels;
    for (const MarkerAssignment& one : setup.assignments()) {
      labels.push_back(setup.model->markers()[one.marker].name.substr(sizeof("MARKER_") - 1));
    }
    return labels;
  }

  std::vector<std::string> Gaps() const {
    std::vector<std::string> texts;
    for (const Gap& gap : LongGaps(setup, recording)) {
      texts.push_back(fmt::format("{} {}-{}", gap.what, gap.first_frame, gap.last_frame));
    }
    return texts;
  }

  /// Of an angle, the frames in which it is not known.
  int Unknown(const std::string& joint, const std::string& side) const {
    AnatomicalAngles angles = ShownAngles(setup, Standing(setup, recording.num_frames()));
    HideUnknown(setup, recording, &angles);
    for (std::size_t i = 0; i < angles.angles.size(); ++i) {
      if (angles.angles[i].joint != joint || angles.angles[i].side != side) continue;
      return static_cast<int>(
          angles.values.row(static_cast<Eigen::Index>(i)).array().isNaN().count());
    }
    ADD_FAILURE() << joint;
    return -1;
  }
};

TEST(CoverageTest, EndsOfTheBodyAreToldByNoOtherPart) {
  const PartlyHidden foot({"LHEE", "LTOE"}, 60);
  EXPECT_THAT(foot.Gaps(), ElementsAre("the left foot 100-159"));
  EXPECT_EQ(foot.Unknown("ankle", "left"), 60);
  EXPECT_EQ(foot.Unknown("knee", "left"), 0);
  EXPECT_EQ(foot.Unknown("ankle", "right"), 0);
  const PartlyHidden heel({"LHEE"}, 60);
  EXPECT_THAT(heel.Gaps(), IsEmpty());
  EXPECT_EQ(heel.Unknown("ankle", "left"), 0);
  const PartlyHidden pelvis({"LASI", "RASI", "LPSI"}, 60);
  EXPECT_THAT(pelvis.Gaps(), ElementsAre("the pelvis 100-159"));
  EXPECT_EQ(pelvis.Unknown("pelvis", ""), 60);
  EXPECT_EQ(pelvis.Unknown("hip", "right"), 60);
  EXPECT_EQ(pelvis.Unknown("knee", "right"), 0);
}

TEST(CoverageTest, ShortGapsAreBridgedAndWholeLegsAreNamedOnce) {
  EXPECT_EQ(PartlyHidden({"LHEE", "LTOE"}, 10).Unknown("ankle", "left"), 0);
  EXPECT_EQ(PartlyHidden({"LHEE", "LTOE"}, 11).Unknown("ankle", "left"), 11);
  const PartlyHidden leg({"LTHI", "LKNE", "LANK", "LHEE", "LTOE"}, 120);
  EXPECT_THAT(leg.Gaps(), ElementsAre("the left leg 100-219"));
  EXPECT_EQ(leg.Unknown("knee", "left"), 120);
}

TEST(CoverageTest, APelvisWithoutMarkersIsNamed) {
  const TrackingSetup legs = SetupWith({"LTHI", "LKNE", "LANK", "LHEE", "LTOE"});
  EXPECT_THAT(DescribeUnshown(legs), StartsWith("the pelvis, "));
  EXPECT_THAT(MeasureCoverage(legs).ends.front().labels, IsEmpty());
}

}  // namespace
}  // namespace mmm_converter
