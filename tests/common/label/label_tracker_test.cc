// SPDX-License-Identifier: MIT
#include "common/label/label_tracker.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/label/body_search.h"
#include "common/support/units.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/unnamed_points.h"

namespace mmm_converter::testing {
namespace {

// At 10 Hz a foot could be where the other one is, if it were not known to stand.
TEST(LabelTrackerTest, FeetThatStandTogetherKeepTheirPoints) {
  const KinematicModel model = ScaledReferenceModel(1.7);
  Subject subject = DrawPerson(model, 951);
  for (MarkerOffset& offset : subject.offsets) {
    offset.standard_deviations.setConstant(0.02);
    offset.skin_deviation = 0.004;
  }
  const KinematicModel person = FitToSubject(model, subject);
  PoseTrajectory motion = RangeOfMotion(model, 40, 0.6, 951);
  std::vector<Posture> standing;
  for (int k = 0; k < motion.num_frames(); k += 10) {
    Posture posture = motion.postures[k];
    posture.position = motion.postures[0].position;
    posture.orientation = motion.postures[0].orientation;
    for (std::size_t j = 0; j < motion.joint_names.size(); ++j) {
      const std::string& name = motion.joint_names[j];
      const bool is_arm = name[1] == 'S' || name[1] == 'E' || name[1] == 'W';
      if (!is_arm) posture.joint_angles[static_cast<Eigen::Index>(j)] = 0;
    }
    standing.push_back(posture);
  }
  motion.postures = standing;
  motion.rate = 10;
  const MarkerSequence recording = RecordPerson(person, motion, 951);
  const UnnamedPoints made = MakeUnnamed(recording, {.hidden = 0.3, .ghosts = 5}, 952);
  const LabelBody body(SetupOf(person, TrackedJoints(model), AssignAll(model, recording)));
  LabelTracker tracker(body);
  int markers = 0, right = 0, wrong = 0;
  for (int k = 0; k < recording.num_frames(); ++k) {
    std::vector<int> columns;
    for (int c = 0; c < made.points.num_labels(); ++c) {
      if (IsSeen(made.points.frame(k).col(c))) columns.push_back(c);
    }
    const Eigen::Matrix3Xd points = made.points.frame(k)(Eigen::all, columns);
    if (k == 0) tracker.Start(BodySearch(body).Find(points));
    const std::vector<int>& point_of_marker = tracker.Track(points, 1 / recording.rate());
    for (int m = 0; m < body.num_markers(); ++m) {
      if (point_of_marker[m] < 0) continue;
      const int truth = made.truth[k][columns[point_of_marker[m]]];
      (truth == m ? right : wrong) += 1;
    }
    for (const int column : columns) markers += made.truth[k][column] >= 0 ? 1 : 0;
  }
  EXPECT_GE(right, 0.985 * markers);
  EXPECT_LE(wrong, 0.01 * markers);  // ghosts that got a name, too
}

}  // namespace
}  // namespace mmm_converter::testing
