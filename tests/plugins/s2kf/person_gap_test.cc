// SPDX-License-Identifier: MIT
// All markers are gone for a while: who comes back is found within a few frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/convert/converter_config.h"
#include "common/model/forward_kinematics.h"
#include "common/motion/marker_synthesis.h"
#include "common/support/units.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "tests/plugins/s2kf/session.h"
#include "tests/plugins/s2kf/session_motions.h"
#include "tests/plugins/s2kf/tracking_run.h"
#include "tests/support/shared_data.h"

namespace mmm_converter::s2kf {
namespace {

constexpr int kGapFrames = 300;
constexpr double kStep = 0.01;         // [s]
constexpr double kSoonThere = 0.03;    // [m] of the joints' centres, in the mean, after 50 ms
constexpr double kThere = 0.01;        // and after half a second
constexpr int kSoon = 5, kLater = 50;  // frames

class PersonGapTest : public ::testing::TestWithParam<const char*> {
 protected:
  PersonGapTest() : session_(1) {
    for (const NamedMotion& named : SessionMotions(session_.model, kGapFrames, session_.seed)) {
      if (named.name == GetParam()) markers_ = session_.Record(named.motion);
    }
  }

  /// As a stream is tracked: the centres of all joints, frame by frame.
  std::vector<Eigen::Matrix3Xd> Track(int begin, int end) const {
    S2kfConverter converter(
        SetupOf(session_.model, session_.joints, AssignAll(session_.model, markers_)),
        ReadSettings(
            ReadConverterConfig(testing::SourcePath("xml_config/converters/s2kf_default.xml"))));
    std::vector<Eigen::Matrix3Xd> centres;
    for (int k = 0; k < markers_.num_frames(); ++k) {
      Eigen::Matrix3Xd frame = markers_.frame(k);
      if (k >= begin && k < end) frame.setConstant(kNaN);
      const FrameEstimate& estimate =
          k == 0 ? converter.Assemble(frame) : converter.Track(frame, kStep);
      EXPECT_TRUE(k != end || estimate.reassembled);
      const auto X = SegmentPoses(session_.model, estimate.posture);
      Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(session_.joints.size()));
      for (std::size_t j = 0; j < session_.joints.size(); ++j) {
        all.col(static_cast<Eigen::Index>(j)) =
            X[session_.model.joint_segment(session_.joints[j])].translation();
      }
      centres.push_back(all);
    }
    return centres;
  }

  Session session_;
  MarkerSequence markers_{{}, 0, 100, 0};
};

TEST_P(PersonGapTest, WhoComesBackIsFoundWithinAFewFrames) {
  const std::vector<Eigen::Matrix3Xd> seen = Track(-1, -1);
  for (const auto& [begin, length] : {std::pair(60, 30), {110, 8}, {100, 100}}) {
    const int end = begin + length;
    const std::vector<Eigen::Matrix3Xd> lost = Track(begin, end);
    const auto off = [&](int k) { return (seen[k] - lost[k]).colwise().norm().mean(); };
    EXPECT_LT(off(end + kSoon), kSoonThere) << begin << " " << length;
    EXPECT_LT(off(end + kLater), kThere) << begin << " " << length;
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, PersonGapTest,
                         ::testing::Values("walking", "quick motion", "cartwheel"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, ' ');
                           return name;
                         });

}  // namespace
}  // namespace mmm_converter::s2kf
