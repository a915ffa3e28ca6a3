// SPDX-License-Identifier: MIT
#include "common/convert/tracking_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/mmm/mmm_model.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/stick_model.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

std::shared_ptr<const KinematicModel> SharedShippedModel() {
  return std::make_shared<const KinematicModel>(
      ReadMmmModel(testing::SourcePath("xml_config/models/mmm.xml")));
}

std::shared_ptr<const KinematicModel> Stick() {
  return std::make_shared<const KinematicModel>(testing::StickModel());
}

// The stick model, which is not scaled.
ConverterConfig StickConfig() {
  ConverterConfig config;
  config.file = "c.xml";
  config.model_processor = "None";
  config.marker_pairs = {{"a", "MARKER_A"}, {"b", "MARKER_B"}, {"c", "MARKER_C"}};
  return config;
}

TEST(TrackingSetup, NeedsLabelsOnly) {
  const auto reference = SharedShippedModel();
  const std::vector<std::string> labels = {"LAEL", "other", "LAOL", "C7"};
  const TrackingSetup setup =
      MakeTrackingSetup({labels}, reference, {}, {.size = WinterScaling{1.8, 70, {}}});
  EXPECT_EQ(setup.marker_set, "KIT");
  EXPECT_THAT(setup.mapping.ignored_labels, ElementsAre("other"));
  ASSERT_EQ(setup.assignments().size(), 3u);
  for (const MarkerAssignment& assignment : setup.assignments()) {
    EXPECT_EQ(setup.model->markers()[assignment.marker].name, "MARKER_" + labels[assignment.label]);
  }
  EXPECT_EQ(setup.joints, ResolveJoints({}, *reference));
  const Eigen::Vector3d p_SM = reference->markers().front().p_SM;
  EXPECT_TRUE(setup.model->markers().front().p_SM.isApprox(1.8 * p_SM, 1e-12));
  EXPECT_NEAR(setup.model->total_mass(), 70 * reference->total_mass(), 1e-9);
}

TEST(TrackingSetup, FitsTheModelToTheSubject) {
  Subject subject;
  subject.offsets.push_back({"MARKER_C7", {0.01, 0.02, 0.03}});
  const PersonScaling known = {WinterScaling{1.8, 70, {}}, std::make_shared<Subject>(subject)};
  const TrackingSetup plain =
      MakeTrackingSetup({{"LAEL", "LAOL", "C7"}}, SharedShippedModel(), {}, {.size = known.size});
  const TrackingSetup fitted =
      MakeTrackingSetup({{"LAEL", "LAOL", "C7"}}, SharedShippedModel(), {}, known);
  const int c7 = plain.model->FindMarker("MARKER_C7");
  EXPECT_TRUE((fitted.model->markers()[c7].p_SM - plain.model->markers()[c7].p_SM)
                  .isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-9));
}

TEST(TrackingSetup, LeavesTheModelAsTheConfigurationSays) {
  const auto reference = Stick();
  const TrackingSetup setup = MakeTrackingSetup({{"a", "b", "c"}}, reference, StickConfig(),
                                                {.size = WinterScaling{1.8, 70, {}}});
  EXPECT_EQ(setup.model, reference);
  EXPECT_EQ(setup.marker_set, "");
}

TEST(TrackingSetup, OfAnObjectHasNoJoints) {
  ModelDescription box;
  box.name = "box";
  box.segments.push_back({.name = "root"});
  for (const char* name : {"MARKER_A", "MARKER_B", "MARKER_C"}) {
    box.markers.push_back({name, 0, Eigen::Vector3d::Random()});
  }
  const auto model = std::make_shared<const KinematicModel>(box);
  Warnings warnings;
  const TrackingSetup setup =
      MakeTrackingSetup({{"c", "a", "b"}, {}, {}}, model, StickConfig(), {}, &warnings);
  EXPECT_EQ(setup.model, model);
  EXPECT_THAT(setup.joints, IsEmpty());
  EXPECT_TRUE(warnings.empty());
  EXPECT_THAT(LabelIndices(setup.assignments()), ElementsAre(1, 2, 0));
}

TEST(TrackingSetup, WarnsOfJointsThatNoMarkerMoves) {
  const TrackingSetup setup = MatchMarkers({{"a", "b", "c"}, {}, {}}, Stick(), StickConfig());
  Warnings warnings;
  WarnOfFreeJoints(setup, StickConfig(), &warnings);
  EXPECT_THAT(setup.joints, ElementsAre(0, 1));
  EXPECT_THAT(warnings.texts(),
              ElementsAre("no marker of the recording is moved by 1 of the 2 tracked joints, whose "
                          "angles are not known: hip"));
}

TEST(TrackingSetup, ErrorsSayWhichRecording) {
  const MarkerLabels labels = {.names = {"x", "y"}, .source = "walk.c3d"};
  EXPECT_THAT([&] { MatchMarkers(labels, Stick(), StickConfig()); },
              ThrowsMessage<Error>(HasSubstr("walk.c3d: no label of the recording is mapped")));
  const MarkerLabels hidden = {{"a", "b", "c"}, {false, false, false}, "walk.c3d"};
  EXPECT_THAT([&] { MatchMarkers(hidden, Stick(), StickConfig()); },
              ThrowsMessage<Error>(HasSubstr("are seen in no frame: a, b, c")));
  EXPECT_THAT([&] { MatchMarkers(labels, Stick(), {}); },
              ThrowsMessage<Error>(
                  AllOf(HasSubstr("walk.c3d: no marker set"), HasSubstr("which has x, y"))));
}

}  // namespace
}  // namespace mmm_converter
