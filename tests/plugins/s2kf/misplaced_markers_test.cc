// SPDX-License-Identifier: MIT
// Markers of an unknown person that are elsewhere for a while, by the whole recording.
#include "plugins/s2kf/misplaced_markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/convert/converter_config.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kFirstWrong = 120;
constexpr int kFirstRight = 220;
constexpr double kWay = 0.06;  // [m]

class MisplacedMarkersTest : public ::testing::Test {
 protected:
  MisplacedMarkersTest() {
    for (const NamedMotion& named : SessionMotions(session_.model, 400, session_.seed)) {
      if (named.name == "range of motion") markers_ = HideBlocks(session_.Record(named.motion), 1);
    }
  }

  S2kfSettings Offline() const {
    return ReadSettings(
        ReadConverterConfig(testing::SourcePath("xml_config/converters/s2kf_offline.xml")));
  }

  ConversionResult Convert(const MarkerSequence& seen, const S2kfSettings& settings) const {
    return S2kfConverter(SetupOf(session_.model, session_.joints, AssignAll(session_.model, seen)),
                         settings)
        .Convert(seen, {});
  }

  /// The marker goes away and comes back.
  MarkerSequence Wander(const std::string& label) const {
    MarkerSequence seen = markers_;
    for (int k = kFirstWrong; k < kFirstRight; ++k) {
      const double share = static_cast<double>(k - kFirstWrong) / (kFirstRight - kFirstWrong);
      seen.frame(k).col(seen.FindLabel(label)).x() += kWay * std::sin(M_PI * share);
    }
    return seen;
  }

  Session session_{3};
  MarkerSequence markers_;
};

TEST_F(MisplacedMarkersTest, RightOnesAreNotNamed) {
  EXPECT_TRUE(Convert(markers_, Offline()).incidents.empty());
}

TEST_F(MisplacedMarkersTest, OneThatWandersIsNamedAndToldAsMeasured) {
  int named = 0;
  for (const std::string label : {"C7", "LANK", "RTHI", "LFHD"}) {
    const MarkerSequence wrong = Wander(label);
    const int l = wrong.FindLabel(label);
    const auto assignments = AssignAll(session_.model, wrong);
    const ConversionResult result = Convert(wrong, Offline());
    if (result.incidents.empty()) continue;
    ++named;
    EXPECT_EQ(result.incidents.size(), 1u) << label;
    const MarkerIncident& found = result.incidents[0];
    EXPECT_EQ(found.kind, MarkerIncident::Kind::kMisplaced);
    EXPECT_EQ(assignments[found.assignment].label, l) << label;
    EXPECT_GT(found.first_frame, kFirstWrong - 20);
    EXPECT_LT(found.last_frame, kFirstRight + 20);
    // Where it is seen, and nowhere else, there is a residual; it counts as wrong.
    int told = 0;
    for (int k = 0; k < wrong.num_frames(); ++k) {
      const bool is_seen = wrong.frame(k).col(l).allFinite();
      EXPECT_EQ(std::isfinite(result.residuals(found.assignment, k)), is_seen) << k;
      told += result.frames[k].markers_wrong;
      int seen = 0;
      for (const MarkerAssignment& one : assignments) {
        seen += wrong.frame(k).col(one.label).allFinite();
      }
      EXPECT_EQ(result.frames[k].markers_seen, seen) << k;
    }
    EXPECT_GT(told, 20);
    EXPECT_LE(told, found.last_frame - found.first_frame + 1);
  }
  EXPECT_GE(named, 2);
}

TEST_F(MisplacedMarkersTest, NothingIsJudgedWhereNothingIsGated) {
  S2kfSettings settings = Offline();
  settings.gate_probability = 0;
  EXPECT_TRUE(Convert(Wander("C7"), settings).incidents.empty());
}

}  // namespace
}  // namespace mmm_converter::s2kf
