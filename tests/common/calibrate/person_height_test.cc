// SPDX-License-Identifier: MIT
#include "common/calibrate/person_height.h"
#include "common/fit/height_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "common/io/mmm/mmm_model.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

constexpr double kTrueHeight = 1.8;  // [m]

PersonHeight Estimate(const MarkerSequence& recording, double visible_share) {
  const KinematicModel reference = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  std::vector<MarkerAssignment> assignments = testing::AssignAll(reference, recording);
  assignments.resize(static_cast<std::size_t>(visible_share * double(assignments.size())));
  return EstimatePersonHeight(
      testing::SetupOf(reference, testing::TrackedJoints(reference), assignments), recording);
}

TEST(PersonHeight, KnowsHowSureItIs) {
  const KinematicModel model = testing::ScaledReferenceModel(kTrueHeight);
  for (const std::uint64_t seed : {71, 72, 73}) {
    const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, seed));
    const MarkerSequence recording =
        testing::RecordPerson(person, testing::RangeOfMotion(model, 6, 0.7, seed), seed);
    const PersonHeight estimate = Estimate(recording, 1);
    EXPECT_LT(std::abs(estimate.height - kTrueHeight), 3 * estimate.deviation) << seed;
    // Lengths that are 3 % off by themselves, of some twelve segments, do not tell it any better.
    EXPECT_GT(estimate.deviation, 0.01);
    EXPECT_LT(estimate.deviation, 0.03);
    EXPECT_EQ(estimate.frames, 24);
  }
}

TEST(PersonHeight, IsExactForThePersonOfTheModel) {
  const KinematicModel model = testing::ScaledReferenceModel(kTrueHeight);
  const MarkerSequence recording =
      testing::RecordPerson(model, testing::RangeOfMotion(model, 6, 0.7, 1), 1);
  // Soft tissue of 4 mm is left, and the weak pulls to natural angles and lengths.
  EXPECT_NEAR(Estimate(recording, 1).height, kTrueHeight, 0.01);
}

// Seven markers tell it badly, and that is said; an ordinary height is weighed in.
TEST(PersonHeight, FewMarkersTellItLess) {
  const KinematicModel model = testing::ScaledReferenceModel(kTrueHeight);
  for (const std::uint64_t seed : {71, 72, 73}) {
    const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, seed));
    const MarkerSequence recording =
        testing::RecordPerson(person, testing::RangeOfMotion(model, 3, 0.7, seed), seed);
    const PersonHeight estimate = Estimate(recording, 0.15);
    EXPECT_LT(std::abs(estimate.height - kTrueHeight), 3 * estimate.deviation) << seed;
    EXPECT_GT(estimate.deviation, 0.03);
    EXPECT_LE(estimate.deviation, kHeightDeviation);
  }
}

TEST(PersonHeight, TooFewMarkersAreAnError) {
  const KinematicModel model = testing::ScaledReferenceModel(kTrueHeight);
  const MarkerSequence recording =
      testing::RecordPerson(model, testing::RangeOfMotion(model, 1, 0.7, 1), 1);
  EXPECT_THROW(Estimate(recording, 0.04), Error);
}

}  // namespace
}  // namespace mmm_converter
