// SPDX-License-Identifier: MIT
#include "common/convert/marker_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "common/io/mmm/mmm_model.h"
#include "common/io/recording/recording.h"
#include "common/support/error.h"
#include "tests/support/shared_data.h"
#include "tests/support/test_folder.h"

namespace mmm_converter {
namespace {

using ::mmm_converter::testing::SharedData;
using ::mmm_converter::testing::SourcePath;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<MarkerSet> ShippedSets() {
  return ReadMarkerSets(SourcePath("xml_config/marker_sets"));
}

KinematicModel ShippedModel() { return ReadMmmModel(SourcePath("xml_config/models/mmm.xml")); }

std::string MessageOf(const std::string& xml) {
  const std::string path = testing::TestFolder() + "/set.xml";
  std::ofstream(path) << xml;
  try {
    ReadMarkerSet(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// The mapping of the chosen set.
MarkerMapping MapRecording(const std::string& file, std::string* set_name,
                           const std::string& subject = "", Warnings* warnings = nullptr) {
  ReadRecordingOptions options;
  if (!subject.empty()) options.subject = subject;
  const Recording recording = ReadRecording(SharedData("recordings/" + file), options);
  const std::vector<MarkerSet> sets = ShippedSets();
  const MarkerSet& set = ChooseMarkerSet(sets, LabelsOf(recording.markers));
  *set_name = set.name;
  const KinematicModel model = ShippedModel();
  return ResolveMarkerMapping(PairsInModel(set, model), LabelsOf(recording.markers), model,
                              warnings);
}

TEST(MarkerSet, ShippedSetsNameMarkersOfTheShippedModel) {
  const KinematicModel model = ShippedModel();
  const std::vector<MarkerSet> sets = ShippedSets();
  ASSERT_EQ(sets.size(), 2u);
  for (const MarkerSet& set : sets) {
    for (const MarkerPair& pair : set.pairs) {
      EXPECT_GE(model.FindMarker(pair.target), 0) << set.file << ": " << pair.target;
    }
    EXPECT_EQ(PairsInModel(set, model).size(), set.pairs.size());
  }
  EXPECT_EQ(sets[0].name, "KIT");
  for (const ModelMarker& marker : model.markers()) {  // KIT's set has them all
    EXPECT_TRUE(std::any_of(sets[0].pairs.begin(), sets[0].pairs.end(),
                            [&](const MarkerPair& pair) { return pair.target == marker.name; }))
        << marker.name;
  }
}

TEST(MarkerSet, PlacesMarkersOnSegmentsAndLinks) {
  const std::string path = testing::TestFolder() + "/places.xml";
  std::ofstream(path) << "<MarkerSet name='s'><Marker name='A' segment='arm' x_mm='1' y_mm='2' "
                         "z_mm='-3'/><Marker name='B' segment='elbow' x_mm='0' y_mm='0' z_mm='10'/>"
                         "<Marker name='C' segment='root' x_mm='5' y_mm='0' z_mm='0'/>"
                         "<Mapping source='own' target='B'/></MarkerSet>";
  const MarkerSet set = ReadMarkerSet(path);
  ModelDescription description;
  description.segments.resize(2);
  description.segments[0].name = "root";
  description.segments[1].name = "elbow";
  description.segments[1].parent = 0;
  description.markers = {{"C", 1, Eigen::Vector3d::Zero()}, {"D", 0, Eigen::Vector3d::Zero()}};
  const KinematicModel placed =
      PlaceMarkers(set, {KinematicModel(description), false, {{"arm", "elbow"}}});
  ASSERT_EQ(placed.markers().size(), 4u);
  EXPECT_EQ(placed.markers()[placed.FindMarker("A")].segment, 1);
  EXPECT_EQ(placed.markers()[placed.FindMarker("A")].p_SM, Eigen::Vector3d(1e-3, 2e-3, -3e-3));
  EXPECT_EQ(placed.markers()[placed.FindMarker("B")].segment, 1);
  EXPECT_EQ(placed.markers()[placed.FindMarker("C")].segment, 0);  // moved
  EXPECT_EQ(placed.markers()[placed.FindMarker("C")].p_SM.x(), 5e-3);
  ASSERT_EQ(set.pairs.size(), 3u);  // B has a label of its own
  EXPECT_EQ(set.pairs[0].source, "own");
  EXPECT_EQ(set.pairs[1].source, "A");
  EXPECT_EQ(set.pairs[1].target, "A");
  EXPECT_EQ(set.pairs[2].source, "C");
}

TEST(MarkerSet, PlacesThatCanNotBeReadAreNamed) {
  EXPECT_THAT(
      MessageOf("<MarkerSet name='s'>\n<Marker name='A' segment='b' x_mm='1' y_mm='nan' "
                "z_mm='1e9'/>\n<Marker name='A' segment='b' x_mm='1' y_mm='1'/></MarkerSet>"),
      AllOf(HasSubstr("set.xml:2: y_mm=\"nan\": must be a number of mm"),
            HasSubstr("set.xml:2: z_mm=\"1e9\""), HasSubstr("set.xml:3: <Marker> needs"),
            HasSubstr("set.xml:3: marker A is placed twice")));
}

TEST(MarkerSetRealFiles, MapsRealRecordings) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  struct {
    const char* file;
    const char* subject;
    const char* set;
    std::size_t markers;
    std::vector<std::string> ignored;
  } const expected[] = {
      {"kit_bimanual_c3d/Cut_1723.c3d", "", "KIT", 53, {}},
      {"synthetic/kit53_lower_case_spaces.c3d", "", "KIT", 53, {}},
      {"synthetic/kit53_two_subjects_same_labels.c3d", "A", "KIT", 53, {}},
      {"whole_body/85_02.c3d", "", "PluginGait", 41, {}},
      {"whole_body/cmu_02_05.c3d", "", "PluginGait", 41, {}},
      {"whole_body/kinematics_tennis_serve.c3d", "", "PluginGait", 39, {}},
      {"whole_body/kinematics_tennis_serve_2players.c3d", "Viktor", "PluginGait", 39, {}},
      {"whole_body/pycgm_movement_trial.c3d", "", "PluginGait", 39, {}},
      {"trc/motek_T.trc", "", "PluginGait", 41, {}}};
  for (const auto& e : expected) {
    SCOPED_TRACE(e.file);
    std::string set;
    const MarkerMapping mapping = MapRecording(e.file, &set, e.subject);
    EXPECT_EQ(set, e.set);
    EXPECT_EQ(mapping.assignments.size(), e.markers);
    EXPECT_EQ(mapping.ignored_labels, e.ignored);
  }
}

TEST(MarkerSetRealFiles, TrustsLessWhatIsWornElsewhereAndSaysSo) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  std::string set;
  Warnings warnings;
  const MarkerMapping mapping = MapRecording("whole_body/85_02.c3d", &set, "", &warnings);
  EXPECT_THAT(warnings.texts(), AllOf(Contains(HasSubstr("LSHN as MARKER_LTIP")),
                                      Contains(HasSubstr("LFIN as MARKER_LHTS")),
                                      Contains(HasSubstr("LWRA as MARKER_LWTS")),
                                      Contains(HasSubstr("LTOE as MARKER_LTOE"))));
  EXPECT_THAT(mapping.absent_markers, ::testing::Not(Contains("MARKER_LTIP")));
  const KinematicModel model = ShippedModel();
  for (const MarkerAssignment& assignment : mapping.assignments) {
    const std::string& name = model.markers()[assignment.marker].name;
    const double expected = name == "MARKER_LTIP" || name == "MARKER_RTHI"   ? 3
                            : name == "MARKER_LWTS" || name == "MARKER_RTOE" ? 2
                            : name == "MARKER_LASI" || name == "MARKER_C7"   ? 1
                                                                             : 0;
    if (expected != 0) {
      EXPECT_EQ(assignment.noise_scale, expected) << name;
    }
  }
}

TEST(MarkerSet, NeedsThreeKnownLabels) {
  const std::vector<MarkerSet> sets = ShippedSets();
  EXPECT_THROW(ChooseMarkerSet(sets, {{"C7", "T10", "box"}}), Error);
  EXPECT_EQ(ChooseMarkerSet(sets, {{"C7", "T10", "LHIP"}}).name, "KIT");
}

TEST(MarkerSet, SaysFileAndLineOfWhatIsWrong) {
  EXPECT_THAT(MessageOf("<MarkerSet name='x'>\n<Mapping source='a' target='M'/>\n</MarkerSet>"),
              HasSubstr("no error"));
  EXPECT_THAT(MessageOf("<Other/>"), HasSubstr("expected <MarkerSet"));
  EXPECT_THAT(MessageOf("<MarkerSet name='x'/>"), HasSubstr("set.xml:1: the set has no <Mapping>"));
  EXPECT_THAT(
      MessageOf("<MarkerSet name='x'>\n<Mapping source='a'/>\n<Map/>\n"
                "<Mapping source='b' target='M' noiseScale='0'/>\n"
                "<Mapping source='B' target='M' weight='1'/>\n</MarkerSet>"),
      AllOf(HasSubstr("set.xml:2: <Mapping> needs the attribute target"),
            HasSubstr("set.xml:3: <Map>: only <Mapping>"), HasSubstr("set.xml:4: noiseScale=\"0\""),
            HasSubstr("set.xml:5: label B"), HasSubstr("no attribute weight")));
  EXPECT_THROW(ReadMarkerSets(testing::TestFolder() + "/no_such_folder"), Error);
}

}  // namespace
}  // namespace mmm_converter
