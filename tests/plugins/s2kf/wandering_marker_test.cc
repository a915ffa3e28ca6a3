// SPDX-License-Identifier: MIT
// A single marker of a calibrated person that is wrong for a second, by so little that a frame by
// itself does not tell.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kFirstWrong = 120;
constexpr int kFirstRight = 220;
constexpr double kWay = 0.06;          // [m]
constexpr double kMostDamage = 0.020;  // the project's bound on a joint's centre [m]

class WanderingMarkerTest : public ::testing::Test {
 protected:
  WanderingMarkerTest() {
    for (const NamedMotion& named : SessionMotions(session_.model, 300, session_.seed)) {
      if (named.name == "waving") markers_ = HideBlocks(session_.Record(named.motion), 1);
    }
    clean_ = Convert(markers_);
  }

  ConversionResult Convert(const MarkerSequence& seen) const {
    return S2kfConverter(SetupOf(person_, session_.joints, AssignAll(person_, seen)), {})
        .Convert(seen, {});
  }

  /// How many of the runs, one for each label, name it while it is wrong; damage counts in all.
  /// share: of kWay by frame since it is wrong.
  template <typename Share>
  int CountNamed(const std::vector<std::string>& labels, Share share) const {
    int named = 0;
    for (const std::string& label : labels) {
      MarkerSequence seen = markers_;
      const int l = seen.FindLabel(label);
      for (int k = kFirstWrong; k < kFirstRight; ++k) {
        seen.frame(k).col(l).x() += kWay * share(k - kFirstWrong);
      }
      const ConversionResult result = Convert(seen);
      named += IsNamed(result, l);
      EXPECT_LE(Damage(result), kMostDamage) << label;
    }
    return named;
  }

  bool IsNamed(const ConversionResult& result, int label) const {
    const auto assignments = AssignAll(person_, markers_);
    return std::any_of(result.incidents.begin(), result.incidents.end(), [&](const auto& found) {
      return assignments[found.assignment].label == label && found.first_frame < kFirstRight &&
             found.last_frame >= kFirstWrong;
    });
  }

  double Damage(const ConversionResult& result) const {
    double largest = 0;
    for (int k = 0; k < result.trajectory.num_frames(); ++k) {
      const auto X = SegmentPoses(person_, ModelPosture(person_, result.trajectory, k));
      const auto X_clean = SegmentPoses(person_, ModelPosture(person_, clean_.trajectory, k));
      for (const int joint : session_.joints) {
        const int s = person_.joint_segment(joint);
        largest = std::max(largest, (X[s].translation() - X_clean[s].translation()).norm());
      }
    }
    return largest;
  }

  Session session_{1};
  KinematicModel person_ = session_.Calibrate();
  MarkerSequence markers_;
  ConversionResult clean_;
};

TEST_F(WanderingMarkerTest, OfACalibratedPersonIsNamedAndCostsLittle) {
  const std::vector<std::string> labels = {"LKNE", "RUPA", "C7", "LTHI", "RFRA"};
  EXPECT_TRUE(clean_.incidents.empty());
  EXPECT_GE(CountNamed(labels, [](int k) { return k / 100.0; }), 4);
  EXPECT_EQ(CountNamed(labels, [](int) { return 1.0; }), 5);
}

}  // namespace
}  // namespace mmm_converter::s2kf
