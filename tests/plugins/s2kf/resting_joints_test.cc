// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "common/io/mmm/mmm_model.h"
#include "common/model/model_scaling.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {
namespace {

class RestingJointsTest : public ::testing::TestWithParam<const char*> {};

// Samples of the other joints would make something of those that move no marker.
TEST_P(RestingJointsTest, AToeThatNoMarkerShowsRests) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const MarkerSequence recording =
      testing::RecordPerson(model, testing::RangeOfMotion(model, 1, 0.6, 5), 5);
  std::vector<MarkerAssignment> assignments = testing::AssignAll(model, recording);
  std::erase_if(assignments, [&](const MarkerAssignment& one) {
    return model.markers()[one.marker].name.ends_with("TOE");
  });
  const ConverterConfig config = ReadConverterConfig(
      testing::SourcePath(std::string("xml_config/converters/") + GetParam() + ".xml"));
  const TrackingSetup setup =
      testing::SetupOf(model, testing::TrackedJoints(model), std::move(assignments));
  const ConversionResult result = S2kfConverter(setup, ReadSettings(config)).Convert(recording, {});
  const auto& names = result.trajectory.joint_names;
  for (const char* joint : {"LFx_joint", "RFx_joint"}) {
    const auto at = std::find(names.begin(), names.end(), joint) - names.begin();
    ASSERT_LT(at, static_cast<std::ptrdiff_t>(names.size()));
    for (const Posture& posture : result.trajectory.postures) {
      ASSERT_NEAR(posture.joint_angles[at], 0, 1e-6) << joint;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, RestingJointsTest,
                         ::testing::Values("s2kf_default", "s2kf_offline", "s2kf_paper", "ekf"));

}  // namespace
}  // namespace mmm_converter::s2kf
