// SPDX-License-Identifier: MIT
#include "common/calibrate/person_height.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "common/io/mmm/mmm_model.h"
#include "tests/support/acrobatics.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

// Persons whose lengths are off by up to 5 % and whose markers sit 28 mm off on each axis. Lengths
// alone leave 15 to 20 mm.
TEST(PersonHeight, IsNearAndHonestOverManyPersons) {
  constexpr double kPersonHeight = 1.8;  // [m]
  constexpr int kPersons = 20;
  const KinematicModel reference = ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml"));
  const KinematicModel model = testing::ScaledReferenceModel(kPersonHeight);
  const std::vector<int> joints = testing::TrackedJoints(model);
  for (const bool is_cartwheel : {false, true}) {
    double squares = 0;
    double worst = 0;
    int within_one = 0;
    int within_two = 0;
    for (std::uint64_t seed = 301; seed < 301 + kPersons; ++seed) {
      const KinematicModel person = FitToSubject(model, testing::DrawPerson(model, seed));
      const PoseTrajectory motion = is_cartwheel ? testing::MakeCartwheel(model)
                                                 : testing::RangeOfMotion(model, 10, 0.7, seed);
      const MarkerSequence recording = testing::RecordPerson(person, motion, seed);
      const PersonHeight estimate = EstimatePersonHeight(
          testing::SetupOf(reference, joints, testing::AssignAll(reference, recording)), recording);
      const double error = std::abs(estimate.height - kPersonHeight);
      squares += error * error;
      worst = std::max(worst, error);
      within_one += error < estimate.deviation ? 1 : 0;
      within_two += error < 2 * estimate.deviation ? 1 : 0;
    }
    const double rms = std::sqrt(squares / kPersons);
    std::cout << "[ measured ] " << (is_cartwheel ? "cartwheel" : "range of motion")
              << ": height rms " << 1e3 * rms << " mm, worst " << 1e3 * worst
              << ", within 1 / 2 sd " << within_one << " / " << within_two << " of " << kPersons
              << "\n";
    EXPECT_LT(rms, 0.026);
    EXPECT_LT(worst, 0.06);
    EXPECT_GE(within_one, 10);
    EXPECT_GE(within_two, 17);
  }
}

}  // namespace
}  // namespace mmm_converter
