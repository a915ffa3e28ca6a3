// SPDX-License-Identifier: MIT
#include "common/label/search/point_fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/math/seeded_random.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

// By so many metres and radians.
Posture Disturbed(const MadePerson& made, double by, std::uint64_t seed) {
  SeededRandom random(seed);
  Posture posture = made.PostureAt(0);
  posture.position += by * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
  for (double& angle : posture.joint_angles) angle += by * random.Normal();
  posture.joint_angles = posture.joint_angles.cwiseMax(made.body.kinematics.lower())
                             .cwiseMin(made.body.kinematics.upper());
  return posture;
}

TEST(PointFitTest, TheCostOfAnAssignmentIsWhatItsMarkersCost) {
  const MadePerson made(11);
  WholeBody whole(made.body);
  PointFit fit;
  const Posture posture = made.PostureAt(0);
  Eigen::Matrix3Xd points = made.PointsAt(0).leftCols(made.body.num_markers() - 2);
  const double cost = fit.Assign(points, MatchCosts::kSettled, posture, &whole);
  const Eigen::Matrix3Xd places = whole.Place(posture);
  double expected = 0.3 * (posture.joint_angles - made.body.natural_angles).squaredNorm();
  for (int m = 0; m < made.body.num_markers(); ++m) {
    const int point = fit.point_of_marker()[m];
    const double variance = made.body.place[m] * made.body.place[m] + 0.015 * 0.015;
    expected += point < 0 ? 9 : (points.col(point) - places.col(m)).squaredNorm() / variance;
  }
  EXPECT_NEAR(cost, expected, 1e-9 * expected);
  EXPECT_EQ(CountOwn(fit.point_of_marker()), made.body.num_markers() - 2);
}

TEST(PointFitTest, AnnealingFindsThePointsOfAPostureNearby) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const MadePerson made(12);
    WholeBody whole(made.body);
    PointFit fit;
    Posture posture = Disturbed(made, 0.08, seed);
    const Eigen::Matrix3Xd points = made.PointsAt(0);
    fit.Anneal(points, {0.2, 0.03, 12}, &whole, &posture);
    const double distance = (whole.Place(posture) - points).colwise().norm().mean();
    EXPECT_LT(distance, 0.03) << "seed " << seed;
  }
}

TEST(PointFitTest, SettlingEndsNoDearerThanItBegan) {
  const MadePerson made(13);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    WholeBody whole(made.body);
    PointFit fit;
    Posture posture = Disturbed(made, 0.15, seed);
    const double before = fit.Assign(made.PointsAt(0), 0.015, posture, &whole);
    const double after = fit.Settle(made.PointsAt(0), {0.015, 6, true}, &whole, &posture);
    EXPECT_LE(after, before);
    // What it leaves behind is what the cost is of.
    const std::vector<int> points = fit.point_of_marker();
    EXPECT_NEAR(fit.Assign(made.PointsAt(0), 0.015, posture, &whole), after, 1e-9 * after);
    EXPECT_EQ(fit.point_of_marker(), points);
  }
}

TEST(PointFitTest, WithoutTurnsNothingMoves) {
  const MadePerson made(14);
  WholeBody whole(made.body);
  PointFit fit;
  Posture posture = Disturbed(made, 0.1, 1);
  const Posture before = posture;
  fit.Settle(made.PointsAt(0), {0.015, 0, false}, &whole, &posture);
  EXPECT_EQ(posture.position, before.position);
  EXPECT_EQ(posture.joint_angles, before.joint_angles);
}

TEST(MovingLimbTest, OnlyItsJointsMove) {
  const MadePerson made(15);
  const LabelBody& body = made.body;
  for (const LabelBody::Limb& limb : body.limbs) {
    MovingLimb moving(body);
    moving.Choose(limb);
    Posture posture = Disturbed(made, 0.1, 3);
    const Posture before = posture;
    const Eigen::Matrix3Xd targets = made.PointsAt(0)(Eigen::all, limb.markers);
    const double far = (moving.Place(posture) - targets).norm();
    moving.Step(targets, moving.Variances(0.015).array().sqrt(), &posture);
    EXPECT_EQ(posture.position, before.position);
    for (int j = 0; j < body.kinematics.num_joints(); ++j) {
      if (std::count(limb.joints.begin(), limb.joints.end(), j) == 0) {
        EXPECT_EQ(posture.joint_angles[j], before.joint_angles[j]);
      }
    }
    EXPECT_LT((moving.Place(posture) - targets).norm(), far + 1e-3);
  }
}

}  // namespace
}  // namespace mmm_converter::testing
