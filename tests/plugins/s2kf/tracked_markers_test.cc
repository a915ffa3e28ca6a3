// SPDX-License-Identifier: MIT
#include "plugins/s2kf/tracked_markers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/math/rotation.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {
namespace {

constexpr double kConfigured = 0.005;  // [m]

Eigen::VectorXd ScaleOf(const KinematicModel& model, const Session& session) {
  const MarkerSequence markers = session.Record(testing::RangeOfMotion(session.model, 1, 0.5, 1));
  const TrackedMarkers tracked(SetupOf(model, session.joints, AssignAll(model, markers)));
  return tracked.FilterScale(kConfigured);
}

TEST(TrackedMarkers, OfAPersonWhomNobodyMeasuredAreAsNoisyAsConfigured) {
  const Session session(1);
  EXPECT_EQ(ScaleOf(session.model, session).minCoeff(), 1);
}

TEST(TrackedMarkers, OfACalibratedPersonAreAsNoisyAsTheirSkinButNotMoreThanConfigured) {
  const Session session(1);
  const Eigen::VectorXd scale = ScaleOf(session.Calibrate(), session);
  // Soft tissue of 4 mm; a marker that alone shows a joint's angle shows little of its own.
  EXPECT_NEAR(kConfigured * scale.mean(), 0.004, 0.001);
  EXPECT_LE(scale.maxCoeff(), 1);
  EXPECT_GE(scale.minCoeff(), 0.2);
}

TEST(TrackedMarkers, WornElsewhereAreThereInEveryPosture) {
  const Session session(1);
  const MarkerSequence markers = session.Record(testing::RangeOfMotion(session.model, 1, 0.5, 1));
  const TrackedMarkers tracked(
      SetupOf(session.model, session.joints, AssignAll(session.model, markers)));
  const int num_markers = tracked.kinematics().num_markers();
  WornPlaces places = {Eigen::Matrix3Xd::Random(3, num_markers),
                       Eigen::VectorXd::Constant(num_markers, 0.01)};
  places.deviation[0] = 0.002;  // counts as the configured one
  const TrackedMarkers worn = tracked.Worn(places);

  Eigen::VectorXd angles = Eigen::VectorXd::Zero(tracked.kinematics().num_joints());
  angles.setConstant(0.1);
  const Eigen::Vector3d position(1, 2, 3);
  const Eigen::Matrix3d R_WS = Exp(Eigen::Vector3d(0.3, -0.2, 0.1)).toRotationMatrix();
  MarkerJacobian of_model = tracked.kinematics().MakeJacobian();
  MarkerJacobian of_worn = worn.kinematics().MakeJacobian();
  tracked.kinematics().ComputeMarkers(position, R_WS, angles, &of_model);
  worn.kinematics().ComputeMarkers(position, R_WS, angles, &of_worn);
  for (int m = 0; m < num_markers; ++m) {
    const Eigen::Matrix3d& R_WL = of_model.R_WL[tracked.kinematics().link_of_marker(m)];
    const Eigen::Vector3d expected = of_model.p_WM.col(m) + R_WL * places.offset.col(m);
    // Rounding of numbers of a few metres.
    EXPECT_LT((of_worn.p_WM.col(m) - expected).norm(), 1e-14) << m;
  }
  EXPECT_EQ(tracked.UsualDeviation(kConfigured), kConfigured);
  const double squares = (num_markers - 1) * 1e-4 + kConfigured * kConfigured;
  EXPECT_DOUBLE_EQ(worn.UsualDeviation(kConfigured), std::sqrt(squares / num_markers));
}

}  // namespace
}  // namespace mmm_converter::s2kf
