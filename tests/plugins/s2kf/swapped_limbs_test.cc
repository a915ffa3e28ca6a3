// SPDX-License-Identifier: MIT
// A limb that bears the other side's labels for a while, and markers that are missing at the start:
// with errors as people wear markers, and a tenth of them hidden.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "common/convert/converter_config.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/acrobatics.h"
#include "tests/support/changed_markers.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kSecond = 100;           // frames
constexpr double kLeastError = 0.010;  // the bound on a joint's centre [m]

S2kfSettings Preset(const std::string& name) {
  return ReadSettings(
      ReadConverterConfig(testing::SourcePath("xml_config/converters/s2kf_" + name + ".xml")));
}

struct SwapScene {
  /// A cartwheel of a person whom the model does not know, or whom it knows exactly.
  explicit SwapScene(bool is_exact, std::uint64_t seed) {
    const KinematicModel person =
        is_exact ? model : FitToSubject(model, testing::DrawPerson(model, seed));
    const MarkerErrors errors = {0, is_exact ? 0 : 0.004, 0.3, 0.0005};
    markers = SynthesizeMarkers(person, testing::MakeCartwheel(model), errors, seed).Slice(0, 300);
    if (!is_exact) markers = testing::OccludeShare(std::move(markers), 0.1, 20, seed);
  }

  /// Somebody whom the model does not know, in one of SessionMotions.
  SwapScene(const std::string& motion, std::uint64_t seed) : SwapScene(false, seed) {
    const Session session(seed);
    for (const NamedMotion& named : SessionMotions(model, 3 * kSecond, seed)) {
      if (named.name != motion) continue;
      markers = HideBlocks(session.Record(named.motion), seed);
    }
  }

  ConversionResult Convert(const S2kfSettings& settings, const MarkerSequence& seen) const {
    return S2kfConverter(SetupOf(model, joints, AssignAll(model, seen)), settings)
        .Convert(seen, {});
  }

  /// The largest distance between the joint centres of two motions from frame `begin` on [m].
  double Largest(const ConversionResult& a, const ConversionResult& b, int begin) const {
    double largest = 0;
    for (int k = begin; k < a.trajectory.num_frames(); ++k) {
      const auto X_a = SegmentPoses(model, ModelPosture(model, a.trajectory, k));
      const auto X_b = SegmentPoses(model, ModelPosture(model, b.trajectory, k));
      for (const int joint : joints) {
        const int s = model.joint_segment(joint);
        largest = std::max(largest, (X_a[s].translation() - X_b[s].translation()).norm());
      }
    }
    return largest;
  }

  KinematicModel model = ScaledReferenceModel(1.8);
  std::vector<int> joints = MotionJoints(model, 44);
  MarkerSequence markers;
};

class SwappedLimbTest : public ::testing::TestWithParam<const char*> {};

TEST_P(SwappedLimbTest, CostsNothingThoughATenthIsHidden) {
  const SwapScene scene(false, 1);
  const S2kfSettings settings = Preset(GetParam());
  const ConversionResult clean = scene.Convert(settings, scene.markers);
  for (const Limb limb : {Limb::kLeg, Limb::kArm}) {
    for (const int begin : {40, 140}) {
      const ConversionResult swapped =
          scene.Convert(settings, SwapSides(scene.markers, limb, begin, begin + kSecond));
      EXPECT_LE(scene.Largest(swapped, clean, 0), kLeastError)
          << (limb == Limb::kLeg ? "legs" : "arms") << " from " << begin;
      // Each seen marker of the limb is taken for its mirror image, and comes back.
      EXPECT_GE(swapped.incidents.size(), limb == Limb::kLeg ? 8U : 9U);
      for (const MarkerIncident& incident : swapped.incidents) {
        EXPECT_LE(incident.last_frame, begin + kSecond + 3);
      }
    }
  }
}

TEST_P(SwappedLimbTest, FeetMayStandBesideEachOther) {
  const S2kfSettings settings = Preset(GetParam());
  for (const auto& [seed, begin] : {std::pair(1, 140), std::pair(4, 40), std::pair(15, 40)}) {
    const SwapScene scene("waving", seed);
    const ConversionResult swapped =
        scene.Convert(settings, SwapSides(scene.markers, Limb::kLeg, begin, begin + kSecond));
    EXPECT_LE(scene.Largest(swapped, scene.Convert(settings, scene.markers), 0), kLeastError)
        << "person " << seed;
  }
}

// They move by 60 mm from frame to frame, where feet are 100 mm apart.
TEST_P(SwappedLimbTest, LegsMayMoveFast) {
  const S2kfSettings settings = Preset(GetParam());
  for (const int seed : {103, 107, 113}) {
    const SwapScene scene("quick motion", seed);
    const ConversionResult swapped =
        scene.Convert(settings, SwapSides(scene.markers, Limb::kLeg, 140, 140 + kSecond));
    EXPECT_LE(scene.Largest(swapped, scene.Convert(settings, scene.markers), 0), kLeastError)
        << "person " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, SwappedLimbTest, ::testing::Values("default", "offline"),
                         [](const auto& test) { return std::string(test.param); });

TEST(SwappedBackTest, LabelsThatAreRightAgainDoNotStayExchanged) {
  const SwapScene scene(true, 1);
  const ConversionResult clean = scene.Convert({}, scene.markers);
  for (int begin = 40; begin < 220; begin += 20) {
    const int end = begin + 30;
    const ConversionResult swapped =
        scene.Convert({}, SwapSides(scene.markers, Limb::kLeg, begin, end));
    for (const MarkerIncident& incident : swapped.incidents) {
      EXPECT_LT(incident.last_frame, end) << "from " << begin;
    }
    EXPECT_LE(scene.Largest(swapped, clean, 0), kLeastError) << "from " << begin;
  }
}

TEST(SwappedBackTest, TheProcessNoiseIsThatOfTheMotion) {
  const SwapScene scene(false, 1);
  const S2kfSettings settings = Preset("offline");
  const double clean = scene.Convert(settings, scene.markers).process_noise_scale.value();
  const MarkerSequence seen = SwapSides(scene.markers, Limb::kArm, 100, 100 + kSecond);
  EXPECT_NEAR(scene.Convert(settings, seen).process_noise_scale.value() / clean, 1, 0.05);
}

TEST(MissingAtTheStartTest, TheTrackIsTheSameASecondAfterTheMarkersAreThere) {
  constexpr int kMissing = 50;
  const SwapScene scene(false, 1);
  const ConversionResult clean = scene.Convert({}, scene.markers);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    MarkerSequence seen = scene.markers;
    const MarkerSequence hidden = testing::OccludeShare(scene.markers, 0.6, 10 * kMissing, seed);
    for (int k = 0; k < kMissing; ++k) seen.frame(k) = hidden.frame(k);
    const ConversionResult late = scene.Convert({}, seen);
    EXPECT_LE(scene.Largest(late, clean, kMissing + kSecond), kLeastError) << seed;
    const auto reassembled =
        std::count_if(late.frames.begin(), late.frames.end(),
                      [](const FrameDiagnostic& frame) { return frame.reassembled; });
    EXPECT_LE(reassembled, 10) << seed;
  }
}

}  // namespace
}  // namespace mmm_converter::s2kf
