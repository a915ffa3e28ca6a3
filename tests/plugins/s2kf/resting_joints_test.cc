// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/io/mmm/mmm_model.h"
#include "common/model/model_scaling.h"
#include "common/model/untold_joints.h"
#include "plugins/s2kf/s2kf_converter.h"
#include "plugins/s2kf/s2kf_settings.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter::s2kf {
namespace {

std::vector<std::string> UntoldNames(const KinematicModel& model, const std::string& markers) {
  std::vector<MarkerIx> indices;
  for (std::size_t m = 0; m < model.markers().size(); ++m) {
    const std::string& name = model.markers()[m].name;
    if (markers.find(name.substr(name.size() - 3)) != std::string::npos) {
      indices.emplace_back(static_cast<int>(m));
    }
  }
  std::vector<std::string> names;
  for (const int joint : UntoldJoints(model, indices)) names.push_back(model.joint(joint).name);
  return names;
}

TEST(UntoldJointsTest, MarkersAcrossAFootTellItsInversion) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const auto inversion = {"LAy_joint", "LMrot_joint", "RAy_joint", "RMrot_joint"};
  const auto metatarsals = {"LMrot_joint", "RMrot_joint"};
  EXPECT_THAT(UntoldNames(model, "HEE TOE"), ::testing::ElementsAreArray(inversion));
  EXPECT_THAT(UntoldNames(model, "TOE"), ::testing::ElementsAreArray(inversion));
  EXPECT_THAT(UntoldNames(model, "HEE MT1 MT5"), ::testing::ElementsAreArray(metatarsals));
  EXPECT_THAT(UntoldNames(model, "HEE ANK MT1 MT5 TOE"), ::testing::IsEmpty());
}

class RestingJointsTest : public ::testing::TestWithParam<const char*> {};

ConversionResult TrackWithout(const std::vector<std::string>& endings, const char* preset) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const MarkerSequence recording =
      testing::RecordPerson(model, testing::RangeOfMotion(model, 1, 0.6, 5), 5);
  std::vector<MarkerAssignment> assignments = testing::AssignAll(model, recording);
  std::erase_if(assignments, [&](const MarkerAssignment& one) {
    const std::string& name = model.markers()[one.marker].name;
    return std::any_of(endings.begin(), endings.end(),
                       [&](const std::string& ending) { return name.ends_with(ending); });
  });
  const ConverterConfig config = ReadConverterConfig(
      testing::SourcePath(std::string("xml_config/converters/") + preset + ".xml"));
  const TrackingSetup setup =
      testing::SetupOf(model, testing::TrackedJoints(model), std::move(assignments));
  return S2kfConverter(setup, ReadSettings(config)).Convert(recording, {});
}

void ExpectRest(const ConversionResult& result, const std::vector<std::string>& joints) {
  const auto& names = result.trajectory.joint_names;
  for (const std::string& joint : joints) {
    const auto at = std::find(names.begin(), names.end(), joint) - names.begin();
    ASSERT_LT(at, static_cast<std::ptrdiff_t>(names.size()));
    for (const Posture& posture : result.trajectory.postures) {
      ASSERT_NEAR(posture.joint_angles[at], 0, 1e-6) << joint;
    }
  }
}

// Samples of the other joints would make something of those that move no marker.
TEST_P(RestingJointsTest, AToeThatNoMarkerShowsRests) {
  ExpectRest(TrackWithout({"TOE"}, GetParam()), {"LFx_joint", "RFx_joint"});
}

TEST_P(RestingJointsTest, AFootOfHeelAndToeDoesNotInvert) {
  ExpectRest(TrackWithout({"MT1", "MT5", "ANK"}, GetParam()),
             {"LAy_joint", "RAy_joint", "LMrot_joint", "RMrot_joint"});
}

INSTANTIATE_TEST_SUITE_P(Presets, RestingJointsTest,
                         ::testing::Values("s2kf_default", "s2kf_offline", "s2kf_paper", "ekf"));

}  // namespace
}  // namespace mmm_converter::s2kf
