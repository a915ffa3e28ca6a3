// SPDX-License-Identifier: MIT
#include "common/model/subject.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/mmm/mmm_model.h"
#include "common/model/forward_kinematics.h"
#include "common/model/model_scaling.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::StickModel;
using ::testing::ThrowsMessage;

// Products and sums of a few numbers below 1: rounding only.
constexpr double kSubjectRounding = 1e-15;

Subject Somebody(const std::string& model) {
  Subject subject;
  subject.model = model;
  subject.height = 1.8;
  subject.mass = 80;
  return subject;
}

/// The stick model with centres of mass, inertia and a prismatic length.
KinematicModel HeavyStick() {
  const KinematicModel stick = StickModel();
  ModelDescription heavy{stick.name(), stick.segments(), stick.markers(), stick.node_sets()};
  for (Segment& segment : heavy.segments) {
    segment.p_SB = {0.01, 0.02, 0.03};
    segment.inertia = Eigen::Vector3d(1e-3, 2e-3, 3e-3).asDiagonal();
  }
  heavy.segments[3].type = JointType::kPrismatic;
  heavy.segments[3].axis = Eigen::Vector3d::UnitZ();
  heavy.segments[3].upper = 0.1;
  return KinematicModel(heavy);
}

TEST(FitToSubject, NobodyInParticularIsTheModelItself) {
  const KinematicModel model = HeavyStick();
  const KinematicModel same = FitToSubject(model, Somebody("stick"));
  for (std::size_t i = 0; i < model.segments().size(); ++i) {
    EXPECT_EQ(same.segments()[i].X_PF.matrix(), model.segments()[i].X_PF.matrix());
  }
  EXPECT_EQ(same.node_sets(), model.node_sets());
  EXPECT_EQ(same.name(), "stick");
}

TEST(FitToSubject, ScalesTheNamedSegmentOnly) {
  Subject subject = Somebody("stick");
  subject.scales = {{"knee", 1.1, 0, 0}, {"plate", 0.9, 0, 0}};
  const KinematicModel model = HeavyStick();
  const KinematicModel fitted = FitToSubject(model, subject);
  const double scales[] = {1, 1.1, 1, 0.9};
  for (int i = 0; i < 4; ++i) {
    const Segment& before = model.segments()[i];
    const Segment& after = fitted.segments()[i];
    EXPECT_NEAR(after.X_PF.translation().z(), scales[i] * before.X_PF.translation().z(),
                kSubjectRounding);
    EXPECT_TRUE(after.p_SB.isApprox(scales[i] * before.p_SB, kSubjectRounding));
    EXPECT_TRUE(after.inertia.isApprox(scales[i] * scales[i] * before.inertia, kSubjectRounding));
    EXPECT_EQ(after.mass, before.mass);
  }
  EXPECT_EQ(fitted.segments()[1].upper, 1);                           // an angle stays
  EXPECT_NEAR(fitted.segments()[3].upper, 0.09, kSubjectRounding);    // a length does not
  EXPECT_NEAR(fitted.markers()[2].p_SM.z(), 0.22, kSubjectRounding);  // at the knee
  EXPECT_EQ(fitted.markers()[3].p_SM.z(), 0.3);
}

TEST(FitToSubject, MovesMarkersAfterScaling) {
  Subject subject = Somebody("stick");
  subject.scales = {{"knee", 1.1, 0, 0}};
  MarkerOffset offset;
  offset.marker = "MARKER_C";
  offset.offset = {0.01, -0.02, 0.03};
  offset.standard_deviations = {0.002, 0.002, 0.002};
  offset.skin_deviation = 0.0015;
  subject.offsets = {offset};
  const KinematicModel fitted = FitToSubject(StickModel(), subject);
  EXPECT_NEAR(fitted.markers()[2].deviation.value(), 0.002, kSubjectRounding);
  EXPECT_EQ(fitted.markers()[2].skin_deviation.value(), 0.0015);
  EXPECT_FALSE(fitted.markers()[1].deviation.has_value());
  EXPECT_FALSE(fitted.markers()[1].skin_deviation.has_value());
  EXPECT_TRUE(
      fitted.markers()[2].p_SM.isApprox(Eigen::Vector3d(0.01, -0.02, 0.25), kSubjectRounding));
  // At the zero posture the knee stands 0.55 m above the root.
  Posture zero;
  zero.joint_angles.setZero(fitted.num_joints());
  const Eigen::Vector3d p_WM = SegmentPoses(fitted, zero)[1] * fitted.markers()[2].p_SM;
  EXPECT_TRUE(p_WM.isApprox(Eigen::Vector3d(0.01, -0.02, 0.80), kSubjectRounding));
}

TEST(FitToSubject, OfTheShippedModelMovesWhatHangsBelow) {
  const KinematicModel scaled = ScaleWinter(
      ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")), {1.75, 70, std::nullopt});
  Subject subject = Somebody(scaled.name());
  subject.scales = {{"LKsegment_joint", 1.05, 0, 0}};
  const KinematicModel fitted = FitToSubject(scaled, subject);
  Posture zero;
  zero.joint_angles.setZero(scaled.num_joints());
  const auto before = SegmentPoses(scaled, zero);
  const auto after = SegmentPoses(fitted, zero);
  const int knee = scaled.FindSegment("LKx_joint");
  const int ankle = scaled.FindSegment("LAx_joint");
  const int other = scaled.FindSegment("RAx_joint");
  ASSERT_TRUE(knee >= 0 && ankle >= 0 && other >= 0);
  const Eigen::Vector3d moved = after[knee].translation() - before[knee].translation();
  const Segment& thigh = scaled.segments()[scaled.FindSegment("LKsegment_joint")];
  EXPECT_NEAR(moved.norm(), 0.05 * thigh.X_PF.translation().norm(), 1e-12);  // sums of metres
  EXPECT_GT(moved.norm(), 0.01);
  EXPECT_TRUE((after[ankle].translation() - before[ankle].translation()).isApprox(moved, 1e-12));
  EXPECT_EQ(after[other].translation(), before[other].translation());
}

TEST(FitToSubject, NamesAllThatTheModelDoesNotHave) {
  Subject subject = Somebody("the model of 2014");
  subject.scales = {{"tail", 1.1, 0, 0}, {"knee", 1.1, 0, 0}};
  MarkerOffset offset;
  offset.marker = "MARKER_X";
  subject.offsets = {offset};
  EXPECT_THAT([&] { FitToSubject(StickModel(), subject); },
              ThrowsMessage<Error>(AllOf(HasSubstr("tail, MARKER_X"), HasSubstr("the model stick"),
                                         HasSubstr("the model of 2014"), Not(HasSubstr("knee")))));
}

TEST(FitToSubject, RefusesWhatIsNotFinite) {
  Subject subject = Somebody("stick");
  subject.scales = {{"knee", std::nan(""), 0, 0}};
  EXPECT_THAT([&] { FitToSubject(StickModel(), subject); },
              ThrowsMessage<Error>(HasSubstr("'knee'")));
}

TEST(Observability, IsWhatTheRecordingsReplaced) {
  EXPECT_EQ(Observability(0, 0.04), 1);
  EXPECT_EQ(Observability(0.04, 0.04), 0);
  EXPECT_DOUBLE_EQ(Observability(0.02, 0.04), 0.75);
}

TEST(Observability, OfAMarkerIsAboutItsMeanVariance) {
  MarkerOffset offset;
  offset.standard_deviations = {0.01, 0.02, 0.02};
  EXPECT_NEAR(Deviation(offset), std::sqrt(3e-4), kSubjectRounding);
}

}  // namespace
}  // namespace mmm_converter
