// SPDX-License-Identifier: MIT
#include "common/label/track/exchanged_names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/support/units.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::testing {
namespace {

constexpr int kGap = 100, kAfterGap = 106;  // frames in which the two markers are hidden

/// A calibrated person in motion, every point with its own name, but for the two in question.
class ExchangedNamesTest : public ::testing::Test {
 protected:
  ExchangedNamesTest() {
    const KinematicModel model = ScaledReferenceModel(1.7);
    Subject subject = DrawPerson(model, 961);
    for (MarkerOffset& offset : subject.offsets) {
      offset.standard_deviations.setConstant(0.01);
      offset.skin_deviation = 0.004;
    }
    const KinematicModel person = FitToSubject(model, subject);
    const PoseTrajectory motion = RangeOfMotion(model, 3, 0.6, 961);
    recording_ = RecordPerson(person, motion, 961);
    a_ = recording_.FindLabel("LWTS");
    b_ = recording_.FindLabel("LWPS");
    for (int k = kGap; k < kAfterGap; ++k) {
      recording_.frame(k).col(a_).setConstant(kNaN);
      recording_.frame(k).col(b_).setConstant(kNaN);
    }
    tracks_ = FollowPoints(recording_);
    for (const PointTrack& track : tracks_.tracks) {
      names_.markers.push_back(tracks_.frames[track.begin].columns[track.points[0]]);
    }
    names_.shares.assign(names_.markers.size(), 1);
    body_ = std::make_unique<LabelBody>(
        SetupOf(person, TrackedJoints(model), AssignAll(model, recording_)));
    postures_ = motion.postures;
  }

  /// The two have each other's names from a frame on.
  TrackNames ExchangedFrom(int frame) const {
    TrackNames names = names_;
    for (std::size_t t = 0; t < names.markers.size(); ++t) {
      int& marker = names.markers[t];
      const bool is_one = marker == a_ || marker == b_;
      if (is_one && tracks_.tracks[t].begin >= frame) marker = a_ + b_ - marker;
    }
    return names;
  }

  TrackNames Improved(TrackNames names) const {
    ExchangedNames exchanged(*body_, tracks_, 0);
    for (int k = 5; k < recording_.num_frames(); k += 10) exchanged.AddFrame(k, postures_[k]);
    exchanged.Improve(&names);
    return names;
  }

  MarkerSequence recording_;
  PointTracks tracks_;
  TrackNames names_;
  std::unique_ptr<LabelBody> body_;
  std::vector<Posture> postures_;
  int a_ = 0, b_ = 0;
};

TEST_F(ExchangedNamesTest, RightNamesStay) { EXPECT_EQ(Improved(names_).markers, names_.markers); }

TEST_F(ExchangedNamesTest, TwoThatAreExchangedAllAlong) {
  const TrackNames wrong = ExchangedFrom(0);
  ASSERT_NE(wrong.markers, names_.markers);
  EXPECT_EQ(Improved(wrong).markers, names_.markers);
}

TEST_F(ExchangedNamesTest, TwoThatAreExchangedAfterAGap) {
  const TrackNames wrong = ExchangedFrom(kAfterGap);
  ASSERT_NE(wrong.markers, names_.markers);
  ASSERT_NE(wrong.markers, ExchangedFrom(0).markers);
  EXPECT_EQ(Improved(wrong).markers, names_.markers);
}

TEST_F(ExchangedNamesTest, ANameThatIsTheOthersWhereThisOneIsHidden) {
  TrackNames wrong = names_;
  for (int& marker : wrong.markers) {
    if (marker == b_) marker = -1;
    if (marker == a_) marker = b_;
  }
  const TrackNames improved = Improved(wrong);
  for (std::size_t t = 0; t < names_.markers.size(); ++t) {
    EXPECT_EQ(improved.markers[t], names_.markers[t] == b_ ? -1 : names_.markers[t]);
  }
}

TEST_F(ExchangedNamesTest, NobodyHasAName) {
  TrackNames none = names_;
  none.markers.assign(none.markers.size(), -1);
  EXPECT_EQ(Improved(none).markers, none.markers);
}

}  // namespace
}  // namespace mmm_converter::testing
