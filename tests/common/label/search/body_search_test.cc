// SPDX-License-Identifier: MIT
#include "common/label/search/body_search.h"

#include <gtest/gtest.h>

#include "common/math/seeded_random.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

TEST(BodySearchTest, APointFarFromEverybodyDoesNotDisturb) {
  const MadePerson made(909, 0.1);
  const LabelBody& body = made.body;
  Eigen::Matrix3Xd points(3, made.recording.num_labels() + 1);
  points << made.recording.frame(0), Eigen::Vector3d(1e6, 0, 0);
  const BodyMatch match = BodySearch(body).Find(points);
  for (int m = 0; m < body.num_markers(); ++m) {
    EXPECT_EQ(match.point_of_marker[m], made.setup.assignments()[m].label);
  }
}

TEST(BodySearchTest, OneFrameIsEnoughInAnyPosture) {
  const MadePerson made(907, 6);
  const LabelBody& body = made.body;
  BodySearch search(body);
  int right = 0, all = 0;
  for (int k = 0; k < made.recording.num_frames(); k += 60) {
    // Lying on the side, and turned.
    const Eigen::Matrix3d turn(Eigen::AngleAxisd(k * EIGEN_PI / 120, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(k, Eigen::Vector3d::UnitZ()));
    const Eigen::Matrix3Xd points = turn * made.recording.frame(k);
    const BodyMatch match = search.Find(points);
    for (int m = 0; m < body.num_markers(); ++m) {
      right += match.point_of_marker[m] == made.setup.assignments()[m].label;
      ++all;
    }
  }
  EXPECT_GE(right, 0.99 * all);
}

TEST(BodySearchTest, TheSameFrameTwiceIsFoundAlike) {
  const MadePerson made(908, 0.1);
  BodySearch search(made.body);
  const BodyMatch first = search.Find(made.PointsAt(0));
  search.Find(made.PointsAt(3));
  const BodyMatch again = search.Find(made.PointsAt(0));
  EXPECT_EQ(first.cost, again.cost);
  EXPECT_EQ(first.point_of_marker, again.point_of_marker);
  EXPECT_EQ(first.posture.joint_angles, again.posture.joint_angles);
}

TEST(BodySearchTest, NearAPostureItIsFoundFromThere) {
  const MadePerson made(910, 0.1);
  BodySearch search(made.body);
  SeededRandom random(910);
  Posture near = made.PostureAt(0);
  for (double& angle : near.joint_angles) angle += 0.1 * random.Normal();
  const BodyMatch match = search.FindNear(made.PointsAt(0), near, 0.06);
  EXPECT_EQ(CountOwn(match.point_of_marker), made.body.num_markers());
  EXPECT_EQ(match.matched, made.body.num_markers());
}

TEST(BodySearchTest, CostsOfPlacesAloneAreHigher) {
  const MadePerson made(911, 0.1);
  BodySearch search(made.body);
  const BodyMatch match = search.Match(made.PointsAt(0), made.PostureAt(0));
  EXPECT_GT(search.Match(made.PointsAt(0), made.PostureAt(0), 0).cost, match.cost);
  const BodyMatch fine = search.SettleFinely(made.PointsAt(0), made.PostureAt(0));
  EXPECT_LE(fine.cost, search.Match(made.PointsAt(0), made.PostureAt(0), 0).cost);
}

TEST(BodySearchTest, WithTheWholeBodyLimbsAreFoundToo) {
  const MadePerson made(912, 0.1);
  BodySearch search(made.body, LimbRestarts::kWithWholeBody);
  EXPECT_GE(CountOwn(search.Find(made.PointsAt(0)).point_of_marker), made.body.num_markers() - 1);
}

}  // namespace
}  // namespace mmm_converter::testing
