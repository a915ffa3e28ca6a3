// SPDX-License-Identifier: MIT
#include "common/calibrate/calibration.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "common/motion/synthetic_motion.h"
#include "common/support/error.h"
#include "tests/support/acrobatics.h"
#include "tests/support/changed_markers.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kHeight = 1.8;

class Trial {
 public:
  Trial(const KinematicModel& model, const PoseTrajectory& motion, std::uint64_t seed)
      : model_(model),
        person_(FitToSubject(model, testing::DrawPerson(model, seed))),
        motion_(motion),
        recording_(testing::RecordPerson(person_, motion, seed)) {}

  CalibrationRecording ForCalibration() const {
    return {"trial", &recording_, testing::AssignAll(model_, recording_)};
  }

  CalibrationResult Calibrate() const {
    return CalibrateSubject(model_, testing::TrackedJoints(model_), {ForCalibration()}, {});
  }

  /// Mean error of joint centres at the least-squares postures of this trial [m].
  double CentreError(const KinematicModel& model) const {
    const PoseTrajectory fitted = testing::FitRecording(
        model, testing::TrackedJoints(model), testing::AssignAll(model, recording_), recording_);
    return testing::MeanCentreError(person_, motion_, model, fitted);
  }

  const KinematicModel& person() const { return person_; }
  MarkerSequence& recording() { return recording_; }

 private:
  const KinematicModel& model_;
  KinematicModel person_;
  PoseTrajectory motion_;
  MarkerSequence recording_;
};

double Of(const std::vector<SegmentScale>& scales, const std::string& name) {
  for (const SegmentScale& scale : scales) {
    if (scale.segment == name) return scale.scale;
  }
  return NAN;
}

// The bound for joint centres is 8 mm; with the true body, soft tissue alone leaves 3.
// Three standard deviations hold nearly all lengths; the heavy tails of the marker prior leave a
// few outside.
TEST(Calibration, FindsAPersonInARangeOfMotionTrialAndKnowsHowSureItIs) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  int outside = 0;
  int all = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Trial trial(model, testing::RangeOfMotion(model, 40, 0.7, seed), seed);
    const CalibrationResult result = trial.Calibrate();
    const KinematicModel fitted = FitToSubject(model, result.subject);
    const Trial held_out(model, MakeHandstand(model), seed);
    const double before = held_out.CentreError(model);
    const double after = held_out.CentreError(fitted);
    std::printf(
        "[ measured ] person %d: joint centres of a handstand %.1f mm -> %.1f mm, true body %.1f "
        "mm\n",
        static_cast<int>(seed), 1000 * before, 1000 * after,
        1000 * held_out.CentreError(held_out.person()));
    EXPECT_GT(before, 0.015);
    EXPECT_LT(after, 0.008);
    EXPECT_LT(result.distance_after, 0.3 * result.distance_before);

    const Subject truth = testing::DrawPerson(model, seed);
    const std::vector<SegmentScale>& found = result.subject.scales;
    for (const SegmentScale& scale : found) {
      const double error = scale.scale - Of(truth.scales, scale.segment);
      outside += std::abs(error) > 3 * scale.standard_deviation;
      ++all;
    }
    EXPECT_NEAR(Of(found, "LKsegment_joint"), Of(truth.scales, "LKsegment_joint"), 0.02);
    EXPECT_NEAR(Of(found, "RAsegment_joint"), Of(truth.scales, "RAsegment_joint"), 0.02);
  }
  EXPECT_LE(outside, all / 20);
}

// Little of a handstand or a cartwheel bends elbows, wrists and ankles: what cannot be known must
// not get worse than the model has it.
TEST(Calibration, DoesNoHarmWhereAMotionTellsLittle) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Trial trial(model, MakeHandstand(model), seed);
    const Trial held_out(model, testing::MakeCartwheel(model), seed);
    const KinematicModel fitted = FitToSubject(model, trial.Calibrate().subject);
    const double before = held_out.CentreError(model);
    const double after = held_out.CentreError(fitted);
    std::printf(
        "[ measured ] person %d, calibrated on a handstand: joint centres of a cartwheel %.1f mm "
        "-> %.1f mm\n",
        static_cast<int>(seed), 1000 * before, 1000 * after);
    EXPECT_LT(after, before);
  }
}

// Ten seconds of somebody who hardly moves: skin that is much the same in frames near each other
// must not be taken for what joints do.
TEST(Calibration, DoesNoHarmWhereAPersonHardlyMoves) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Trial trial(model, testing::RangeOfMotion(model, 10, 0.15, seed), seed);
    const Trial held_out(model, testing::MakeCartwheel(model), seed);
    const KinematicModel fitted = FitToSubject(model, trial.Calibrate().subject);
    const double before = held_out.CentreError(model);
    const double after = held_out.CentreError(fitted);
    std::printf(
        "[ measured ] person %d, hardly moving: joint centres of a cartwheel %.1f mm -> %.1f mm\n",
        static_cast<int>(seed), 1000 * before, 1000 * after);
    EXPECT_LT(after, 0.6 * before);
  }
}

TEST(Calibration, TheModelsOwnPersonStaysTheModel) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  const MarkerSequence recording =
      testing::RecordPerson(model, testing::RangeOfMotion(model, 30, 0.7, 4), 4);
  const Subject found =
      CalibrateSubject(model, testing::TrackedJoints(model),
                       {{"trial", &recording, testing::AssignAll(model, recording)}}, {})
          .subject;
  // 4 mm of soft tissue over some hundred frames: about a millimetre, and the body's proportions to
  // a percent or two.
  for (const SegmentScale& scale : found.scales) EXPECT_NEAR(scale.scale, 1, 0.03) << scale.segment;
  double sum = 0;
  for (const MarkerOffset& offset : found.offsets) sum += offset.offset.norm();
  EXPECT_LT(sum / static_cast<double>(found.offsets.size()), 0.006);
}

TEST(Calibration, SeveralRecordingsOfOnePersonAddUp) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  const Trial arms(model, testing::RangeOfMotion(model, 6, 0.7, 8), 8);
  const Trial more(model, testing::RangeOfMotion(model, 10, 0.7, 9), 8);
  const CalibrationResult both = CalibrateSubject(
      model, testing::TrackedJoints(model), {arms.ForCalibration(), more.ForCalibration()}, {});
  ASSERT_EQ(both.subject.sources.size(), 2);
  EXPECT_GT(both.subject.sources[0].frames, 0);
  EXPECT_GT(both.subject.sources[1].frames, 0);
  EXPECT_EQ(both.subject.sources[0].frames + both.subject.sources[1].frames, both.frames);
  const Trial held_out(model, MakeHandstand(model), 8);
  EXPECT_LT(held_out.CentreError(FitToSubject(model, both.subject)),
            held_out.CentreError(FitToSubject(model, arms.Calibrate().subject)));
}

TEST(Calibration, SaysThatMarkersWerePutOnAnew) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  const Trial one(model, testing::RangeOfMotion(model, 6, 0.7, 8), 8);
  const Trial same(model, testing::RangeOfMotion(model, 6, 0.7, 9), 8);
  const Trial anew(model, testing::RangeOfMotion(model, 6, 0.7, 9), 9);
  const auto moved = [&](const Trial& other) {
    return CalibrateSubject(model, testing::TrackedJoints(model),
                            {one.ForCalibration(), other.ForCalibration()}, {})
        .moved;
  };
  EXPECT_TRUE(moved(same).empty());
  const std::vector<MovedMarkers> found = moved(anew);
  ASSERT_FALSE(found.empty());
  EXPECT_GE(4 * found.front().moved, found.front().markers);
}

TEST(Calibration, SwappedLabelsAndGapsDoNotBendIt) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  Trial trial(model, testing::RangeOfMotion(model, 40, 0.7, 1), 1);
  trial.recording() = testing::SwapMarkers(trial.recording(), "LKNE", "RKNE", 1000, 1400);
  trial.recording() = testing::SwapMarkers(trial.recording(), "LFRA", "LWPS", 2000, 2600);
  trial.recording() = testing::OccludeShare(trial.recording(), 0.2, 100, 1);
  const Trial held_out(model, MakeHandstand(model), 1);
  EXPECT_LT(held_out.CentreError(FitToSubject(model, trial.Calibrate().subject)), 0.008);
}

TEST(Calibration, IsTheSameEachTime) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  const Trial trial(model, testing::RangeOfMotion(model, 4, 0.7, 1), 1);
  const Subject a = trial.Calibrate().subject;
  const Subject b = trial.Calibrate().subject;
  for (std::size_t i = 0; i < a.scales.size(); ++i) EXPECT_EQ(a.scales[i].scale, b.scales[i].scale);
  for (std::size_t i = 0; i < a.offsets.size(); ++i) {
    EXPECT_EQ(a.offsets[i].offset, b.offsets[i].offset);
  }
}

std::string MessageOf(const Trial& trial) {
  try {
    trial.Calibrate();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Calibration, SaysThatARecordingIsTooShort) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  const Trial trial(model, testing::RangeOfMotion(model, 1.5, 0.7, 1), 1);
  EXPECT_THAT(MessageOf(trial),
              AllOf(HasSubstr("too short"), HasSubstr("15 frames"), HasSubstr("20 are needed")));
}

TEST(Calibration, SaysThatARecordingIsTooStill) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  const Trial trial(model, testing::RangeOfMotion(model, 20, 0.02, 1), 1);
  EXPECT_THAT(MessageOf(trial),
              AllOf(HasSubstr("too still"), HasSubstr("degrees"), HasSubstr("knees bend")));
}

TEST(Calibration, NothingSeenIsTooShort) {
  const KinematicModel model = testing::ScaledReferenceModel(kHeight);
  Trial trial(model, testing::RangeOfMotion(model, 5, 0.7, 1), 1);
  trial.recording() = testing::HideAllMarkers(trial.recording(), 0, 500);
  EXPECT_THAT(MessageOf(trial), HasSubstr("too short to calibrate on: 0 frames"));
}

}  // namespace
}  // namespace mmm_converter
