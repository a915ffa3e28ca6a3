// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "common/calibrate/calibration.h"
#include "common/convert/converter_config.h"
#include "common/io/recording/recording.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

struct HeldOut {
  double before = 0;  ///< mean marker distance of the framewise optimum [m]
  double after = 0;
};

/// Calibrated on the first half of a recording, measured on the second.
HeldOut CalibrateOnFirstHalf(const std::string& path, double height) {
  const MarkerSequence all = ReadRecording(testing::SharedData(path), {}).markers;
  const KinematicModel model = testing::ScaledReferenceModel(height);
  ConverterConfig config;
  config.marker_set = "auto";
  const TrackingSetup setup =
      MatchMarkers(LabelsOf(all), std::make_shared<const KinematicModel>(model), config);
  const auto& assignments = setup.assignments();
  const int half = all.num_frames() / 2;
  const MarkerSequence first = all.Slice(0, half);
  const MarkerSequence second = all.Slice(half, all.num_frames());
  const std::vector<int> joints = testing::TrackedJoints(model);
  const Subject subject =
      CalibrateSubject(model, joints, {{path, &first, assignments}}, {}).subject;
  const auto distance = [&](const KinematicModel& person) {
    return testing::MeanDistance(person, assignments, second,
                                 testing::FitRecording(person, joints, assignments, second));
  };
  const HeldOut result = {distance(model), distance(FitToSubject(model, subject))};
  std::printf("[ measured ] %s: marker distance of the second half %.2f mm -> %.2f mm\n",
              path.c_str(), 1000 * result.before, 1000 * result.after);
  return result;
}

// The bound.
TEST(CalibrationOfRealRecordings, KitHeldOutHalfIsWithinFourMillimetres) {
  MMM_CONVERTER_NEEDS_SHARED_DATA()
  for (const char* name : {"Close_1723", "Cut_1723", "Peel_1723", "Stir_1723", "Pour_1480"}) {
    const double height = std::string(name).find("1480") != std::string::npos ? 1.79 : 1.68;
    const HeldOut held_out =
        CalibrateOnFirstHalf(std::string("recordings/kit_bimanual_c3d/") + name + ".c3d", height);
    EXPECT_LT(held_out.after, 0.004) << name;
  }
}

// No bound is known for these: 41 markers of another set; the second half of 85_02 is the jump,
// with postures that the first half does not show.
TEST(CalibrationOfRealRecordings, CmuHeldOutHalfIsMuchNearer) {
  MMM_CONVERTER_NEEDS_SHARED_DATA()
  for (const char* name : {"85_02", "cmu_02_05"}) {
    const HeldOut held_out =
        CalibrateOnFirstHalf(std::string("recordings/whole_body/") + name + ".c3d", 1.8);
    EXPECT_LT(held_out.after, 0.5 * held_out.before) << name;
  }
}

}  // namespace
}  // namespace mmm_converter
