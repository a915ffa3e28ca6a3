// SPDX-License-Identifier: MIT
#include "plugins/s2kf/tracked_markers.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mmm_converter::s2kf
