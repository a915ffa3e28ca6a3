// SPDX-License-Identifier: MIT
#include "common/model/model_scaling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// root > elbow > LWy_joint > palm > finger, and RWy_joint at the root.
KinematicModel Arm() {
  ModelDescription arm;
  for (const char* name : {"root", "elbow", "LWy_joint", "palm", "finger", "RWy_joint"}) {
    Segment segment;
    segment.name = name;
    segment.parent = static_cast<int>(arm.segments.size()) - 1;
    segment.X_PF.translation().z() = 0.1;
    segment.mass = 0.2;
    segment.p_SB = {0.01, 0, 0};
    segment.inertia = Eigen::Vector3d(1e-3, 2e-3, 3e-3).asDiagonal();
    arm.segments.push_back(segment);
  }
  arm.segments[5].parent = 0;
  arm.segments[1].type = JointType::kPrismatic;
  arm.segments[1].upper = 0.1;
  arm.segments[2].type = JointType::kRevolute;
  arm.segments[2].upper = 1.5;
  arm.markers = {{"E", 1, {0, 0.02, 0}}, {"F", 4, {0, 0.03, 0}}};
  arm.node_sets["Hand"] = {"palm", "finger"};
  return KinematicModel(arm);
}

// Products of a few numbers: rounding only.
constexpr double kScalingRounding = 1e-15;

TEST(WinterScaling, ScalesLengthsMassesAndInertia) {
  const KinematicModel scaled = ScaleWinter(Arm(), {1.6, 50, std::nullopt});
  for (const Segment& segment : scaled.segments()) {
    EXPECT_NEAR(segment.X_PF.translation().z(), 0.16, kScalingRounding) << segment.name;
    EXPECT_NEAR(segment.p_SB.x(), 0.016, kScalingRounding);
    EXPECT_NEAR(segment.mass, 10, 1e-14);
    EXPECT_NEAR(segment.inertia(1, 1), 2e-3 * 50 * 1.6 * 1.6, 1e-14);
  }
  EXPECT_NEAR(scaled.segments()[1].upper, 0.16, kScalingRounding);  // the prismatic length record
  EXPECT_EQ(scaled.segments()[2].upper, 1.5);                       // an angle
  EXPECT_NEAR(scaled.markers()[0].p_SM.y(), 0.032, kScalingRounding);
  EXPECT_EQ(scaled.node_sets(), Arm().node_sets());
}

TEST(WinterScaling, HandLengthScalesWhatIsBelowTheWrist) {
  const double hand = 0.2 / kWinterHandLength;
  const KinematicModel scaled = ScaleWinter(Arm(), {1.6, 50, 0.2});
  const double lengths[] = {1.6, 1.6, 1.6, hand, hand, 1.6};
  for (int i = 0; i < 6; ++i) {
    const Segment& segment = scaled.segments()[i];
    EXPECT_NEAR(segment.X_PF.translation().z(), 0.1 * lengths[i], kScalingRounding) << segment.name;
    EXPECT_NEAR(segment.p_SB.x(), 0.01 * lengths[i], kScalingRounding);
    EXPECT_NEAR(segment.mass, 10, 1e-14);
    EXPECT_NEAR(segment.inertia(0, 0), 1e-3 * 50 * lengths[i] * lengths[i], 1e-14);
  }
  EXPECT_NEAR(scaled.markers()[0].p_SM.y(), 0.032, kScalingRounding);
  EXPECT_NEAR(scaled.markers()[1].p_SM.y(), 0.03 * hand, kScalingRounding);
}

TEST(WinterScaling, LengthsAreSaidForEachSegment) {
  EXPECT_THAT(WinterLengths(Arm(), {1.6, 50, std::nullopt}),
              ElementsAre(1.6, 1.6, 1.6, 1.6, 1.6, 1.6));
  const double hand = 0.2 / kWinterHandLength;
  EXPECT_THAT(WinterLengths(Arm(), {1.6, 50, 0.2}), ElementsAre(1.6, 1.6, 1.6, hand, hand, 1.6));
}

TEST(WinterScaling, WintersOwnHandLengthChangesNothing) {
  const KinematicModel plain = ScaleWinter(Arm(), {1.75, 70, std::nullopt});
  const KinematicModel with_hand = ScaleWinter(Arm(), {1.75, 70, 0.108 * 1.75});
  for (std::size_t i = 0; i < plain.segments().size(); ++i) {
    EXPECT_TRUE(with_hand.segments()[i].X_PF.isApprox(plain.segments()[i].X_PF, kScalingRounding));
  }
}

TEST(WinterScaling, RefusesImpossiblePersons) {
  const KinematicModel arm = Arm();
  const auto scale = [&](const WinterScaling& person) {
    return [&arm, person] { ScaleWinter(arm, person); };
  };
  EXPECT_THAT(scale({17.5, 70, {}}),
              ThrowsMessage<Error>("height 17.5 m is outside 0.5 to 2.5 m; give metres"));
  EXPECT_THAT(scale({std::numeric_limits<double>::quiet_NaN(), 70, {}}),
              ThrowsMessage<Error>(HasSubstr("height nan m is outside")));
  EXPECT_THAT(scale({1.75, 0, {}}),
              ThrowsMessage<Error>(HasSubstr("mass 0 kg is outside 1 to 400")));
  EXPECT_THAT(scale({1.75, 70, 18.0}),
              ThrowsMessage<Error>(HasSubstr("hand length 18 m is outside 0.05 to 0.4 m")));
}

TEST(WinterScaling, HandLengthNeedsWrists) {
  ModelDescription stump;
  stump.segments.resize(1);
  stump.segments[0].name = "root";
  EXPECT_THAT(
      [&] {
        ScaleWinter(KinematicModel(stump), {1.75, 70, 0.18});
      },
      ThrowsMessage<Error>(HasSubstr("LWy_joint and RWy_joint")));
}

}  // namespace
}  // namespace mmm_converter
