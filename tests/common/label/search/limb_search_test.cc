// SPDX-License-Identifier: MIT
#include "common/label/search/limb_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "common/label/search/body_search.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

// A match in which one limb is at its middle angles instead of where its points are.
BodyMatch WithLimbElsewhere(const MadePerson& made, const LabelBody::Limb& limb) {
  Posture posture = made.PostureAt(0);
  for (const int j : limb.joints) {
    const auto [lower, upper] = made.body.kinematics.Range(j);
    const double other = 0.5 * (lower + upper);
    const double away = std::clamp(posture.joint_angles[j] + 0.8, lower, upper);
    posture.joint_angles[j] = std::abs(other - posture.joint_angles[j]) > 0.5 ? other : away;
  }
  return BodySearch(made.body).Match(made.PointsAt(0), posture);
}

TEST(LimbSearchTest, EachLimbIsFoundWhereItsPointsAreAndTheRestStays) {
  const MadePerson made(31);
  int tried = 0;
  for (const LabelBody::Limb& limb : made.body.limbs) {
    if (limb.markers.size() < 3) continue;
    BodyMatch match = WithLimbElsewhere(made, limb);
    const Posture before = match.posture;
    LimbSearch search(made.body);
    if (search.MostGain(made.PointsAt(0), match) < 20) continue;
    SeededRandom random(31);
    EXPECT_TRUE(search.Improve(made.PointsAt(0), 200, &random, &match));
    EXPECT_EQ(match.posture.position, before.position);
    for (const int m : limb.markers) EXPECT_EQ(match.point_of_marker[m], m);
    ++tried;
  }
  EXPECT_GE(tried, 3);
}

TEST(LimbSearchTest, CostsAreThoseOfTheMatch) {
  const MadePerson made(32);
  BodyMatch match = WithLimbElsewhere(made, made.body.limbs[0]);
  LimbSearch search(made.body);
  SeededRandom random(32);
  search.Improve(made.PointsAt(0), 100, &random, &match);
  const BodyMatch again = BodySearch(made.body).Match(made.PointsAt(0), match.posture);
  EXPECT_LE(again.cost, match.cost + 1e-6);
}

TEST(LimbSearchTest, WhereAllFitsNothingIsTried) {
  const MadePerson made(33);
  BodyMatch match = BodySearch(made.body).SettleFinely(made.PointsAt(0), made.PostureAt(0));
  LimbSearch search(made.body);
  SeededRandom random(33), untouched(33);
  EXPECT_LT(search.MostGain(made.PointsAt(0), match), 1);
  EXPECT_FALSE(search.Improve(made.PointsAt(0), 50, &random, &match));
  EXPECT_EQ(random.Uniform(), untouched.Uniform());
}

TEST(LimbSearchTest, AMarkerWithoutAnyPointInReachCannotBeSpared) {
  const MadePerson made(34);
  // All points of one limb are hidden: no other point could be its.
  const LabelBody::Limb& limb = made.body.limbs[0];
  std::vector<int> left;
  for (int m = 0; m < made.body.num_markers(); ++m) {
    if (made.body.limb_of_marker[m] != 0) left.push_back(m);
  }
  const Eigen::Matrix3Xd points = made.PointsAt(0)(Eigen::all, left);
  const BodyMatch match = BodySearch(made.body).Match(points, made.PostureAt(0));
  for (const int m : limb.markers) EXPECT_EQ(match.point_of_marker[m], -1);
  EXPECT_LT(LimbSearch(made.body).MostGain(points, match), 1);
}

TEST(RandomizeJointsTest, AnglesAreInsideTheLimitsAndTheFirstHalfMayStay) {
  const MadePerson made(35);
  const std::vector<int>& joints = made.body.limbs[0].joints;
  SeededRandom random(35);
  int kept_first = 0;
  for (int i = 0; i < 200; ++i) {
    Posture posture = made.PostureAt(0);
    RandomizeJoints(made.body.kinematics, joints, i % 2 == 0, &random, &posture);
    for (int j = 0; j < posture.joint_angles.size(); ++j) {
      const auto [lower, upper] = made.body.kinematics.Range(j);
      const double angle = posture.joint_angles[j];
      if (std::count(joints.begin(), joints.end(), j) == 0) {
        EXPECT_EQ(angle, made.PostureAt(0).joint_angles[j]);
      } else {
        EXPECT_GE(angle, lower);
        EXPECT_LE(angle, upper);
      }
    }
    kept_first += posture.joint_angles[joints[0]] == made.PostureAt(0).joint_angles[joints[0]];
  }
  EXPECT_GT(kept_first, 60);
  EXPECT_LT(kept_first, 140);
}

}  // namespace
}  // namespace mmm_converter::testing
