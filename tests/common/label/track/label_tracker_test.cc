// SPDX-License-Identifier: MIT
#include "common/label/track/label_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "common/label/search/body_search.h"
#include "common/support/units.h"
#include "tests/common/label/made_person.h"
#include "tests/support/synthetic_person.h"
#include "tests/support/unnamed_points.h"

namespace mmm_converter::testing {
namespace {

struct Followed {
  int markers = 0, right = 0, wrong = 0;  // points; ghosts that got a name are wrong, too
  std::vector<int> found;                 // frames in which a marker had its own point
};

Followed Follow(const TrackingSetup& setup, const UnnamedPoints& made) {
  const LabelBody body(setup);
  LabelTracker tracker(body);
  Followed followed;
  followed.found.resize(static_cast<std::size_t>(body.num_markers()));
  for (int k = 0; k < made.points.num_frames(); ++k) {
    std::vector<int> columns;
    for (int c = 0; c < made.points.num_labels(); ++c) {
      if (IsSeen(made.points.frame(k).col(c))) columns.push_back(c);
    }
    const Eigen::Matrix3Xd points = made.points.frame(k)(Eigen::all, columns);
    if (k == 0) tracker.Start(BodySearch(body).Find(points));
    const std::vector<int>& point_of_marker = tracker.Track(points, 1 / made.points.rate());
    for (int m = 0; m < body.num_markers(); ++m) {
      if (point_of_marker[m] < 0) continue;
      const int truth = made.truth[k][columns[point_of_marker[m]]];
      (truth == m ? followed.right : followed.wrong) += 1;
      followed.found[m] += truth == m ? 1 : 0;
    }
    for (const int column : columns) followed.markers += made.truth[k][column] >= 0 ? 1 : 0;
  }
  return followed;
}

KinematicModel Calibrated(const KinematicModel& model, std::uint64_t seed, double deviation) {
  Subject subject = DrawPerson(model, seed);
  for (MarkerOffset& offset : subject.offsets) {
    offset.standard_deviations.setConstant(deviation);
    offset.skin_deviation = 0.004;
  }
  return FitToSubject(model, subject);
}

// A shoulder's marker slides by so much [m] in frames [begin, end), where no other marker is.
void ExpectKeepsItsPoint(std::uint64_t seed, double slide, int begin, int end) {
  const KinematicModel model = ScaledReferenceModel(1.7);
  const KinematicModel person = Calibrated(model, seed, 0.01);
  MarkerSequence recording = RecordPerson(person, RangeOfMotion(model, 3, 0.6, seed), seed);
  const int slides = recording.FindLabel("LSHO");
  for (int k = 0; k < recording.num_frames(); ++k) {
    const double share = static_cast<double>(k - begin) / (end - begin);
    recording.frame(k)(2, slides) += slide * std::clamp(share, 0.0, 1.0);
  }
  const Followed followed =
      Follow(SetupOf(person, TrackedJoints(model), AssignAll(model, recording)),
             MakeUnnamed(recording, {}, seed + 1));
  EXPECT_EQ(followed.found[slides], recording.num_frames());
  EXPECT_EQ(followed.wrong, 0);
}

TEST(LabelTrackerTest, WhatSlidesFarKeepsItsPoint) { ExpectKeepsItsPoint(953, 0.07, 40, 80); }

// As in a throw: faster than the place is followed.
TEST(LabelTrackerTest, WhatSlidesFastKeepsItsPoint) { ExpectKeepsItsPoint(955, 0.12, 40, 60); }

// At 10 Hz a foot could be where the other one is, if it were not known to stand.
TEST(LabelTrackerTest, FeetThatStandTogetherKeepTheirPoints) {
  const KinematicModel model = ScaledReferenceModel(1.7);
  const KinematicModel person = Calibrated(model, 951, 0.02);
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
  const Followed followed =
      Follow(SetupOf(person, TrackedJoints(model), AssignAll(model, recording)),
             MakeUnnamed(recording, {.hidden = 0.3, .ghosts = 5}, 952));
  EXPECT_GE(followed.right, 0.985 * followed.markers);
  EXPECT_LE(followed.wrong, 0.01 * followed.markers);
}

void ExpectSame(const LabelBelief& a, const LabelBelief& b) {
  EXPECT_EQ(a.posture.position, b.posture.position);
  EXPECT_EQ(a.posture.joint_angles, b.posture.joint_angles);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.P_qq, b.P_qq);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.offset_variance, b.offset_variance);
}

TEST(LabelTrackerTest, AssigningBetweenChangesNothingOfTheTrack) {
  const MadePerson made(961);
  LabelTracker tracker(made.body), other(made.body), untouched(made.body);
  BodyMatch start;
  start.posture = made.PostureAt(0);
  tracker.Start(start);
  untouched.Start(start);
  start.posture = made.PostureAt(10);
  other.Start(start);
  for (int k = 1; k < 5; ++k) {
    tracker.Track(made.PointsAt(k), 0.01);
    untouched.Track(made.PointsAt(k), 0.01);
    other.Track(made.PointsAt(10 - k), 0.01);
    const LabelTracker::Prediction before = tracker.prediction();
    const std::vector<int> between =
        tracker.AssignBetween(made.PointsAt(k), other.prediction(), {});
    EXPECT_EQ(CountOwn(between), made.body.num_markers());
    ExpectSame(tracker.belief(), untouched.belief());
    EXPECT_EQ(tracker.prediction().posture.joint_angles, before.posture.joint_angles);
    EXPECT_EQ(tracker.prediction().information, before.information);
    EXPECT_EQ(tracker.prediction().offset, before.offset);
  }
}

// Two points as near to a marker: the one that is guessed is its.
TEST(LabelTrackerTest, AHintDecidesBetweenPointsAsLikely) {
  const MadePerson made(962);
  for (const int guessed : {0, 1}) {
    LabelTracker tracker(made.body);
    BodyMatch start;
    start.posture = made.PostureAt(0);
    tracker.Start(start);
    tracker.Track(made.PointsAt(0), 0.01);
    Eigen::Matrix3Xd points(3, made.body.num_markers() + 1);
    points << made.PointsAt(1), made.PointsAt(1).col(5);
    LabelTracker::Hints hints;
    hints.markers.assign(static_cast<std::size_t>(points.cols()), -1);
    hints.worth.assign(hints.markers.size(), 20);
    const int point = guessed == 0 ? 5 : made.body.num_markers();
    hints.markers[point] = 5;
    EXPECT_EQ(tracker.Track(points, 0.01, hints)[5], point);
  }
}

TEST(LabelTrackerTest, WhatIsRestoredGoesOnFromThere) {
  const MadePerson made(963);
  LabelTracker tracker(made.body);
  BodyMatch start;
  start.posture = made.PostureAt(0);
  tracker.Start(start);
  tracker.Track(made.PointsAt(1), 0.01);
  const LabelBelief kept = tracker.belief();
  tracker.Track(made.PointsAt(2), 0.01);
  tracker.Restore(kept);
  ExpectSame(tracker.belief(), kept);
  EXPECT_EQ(CountOwn(tracker.Track(made.PointsAt(2), 0.01)), made.body.num_markers());
}

}  // namespace
}  // namespace mmm_converter::testing
