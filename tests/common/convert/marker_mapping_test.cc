// SPDX-License-Identifier: MIT
#include "common/convert/marker_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/model/kinematic_model.h"
#include "common/motion/marker_sequence.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One segment with markers MARKER_A to MARKER_D.
KinematicModel MakeModel() {
  ModelDescription description;
  description.name = "mmm";
  description.segments.push_back({.name = "root_joint"});
  for (const char* name : {"MARKER_A", "MARKER_B", "MARKER_C", "MARKER_D"}) {
    description.markers.push_back({name, 0, Eigen::Vector3d::Zero()});
  }
  return KinematicModel(description);
}

/// Two frames; labels are seen but for those that start with an X.
MarkerSequence MakeRecording(const std::vector<std::string>& labels) {
  MarkerSequence recording(labels, 2, 100, 0);
  for (int i = 0; i < recording.num_labels(); ++i) {
    if (labels[i][0] != 'X') recording.frame(1).col(i).setOnes();
  }
  return recording;
}

std::string MessageOf(const std::vector<MarkerPair>& pairs, const MarkerSequence& recording) {
  try {
    ResolveMarkerMapping(pairs, LabelsOf(recording, "walk.c3d"), MakeModel());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MarkerMapping, ResolvesByMarkerWithoutCaseBlanksAndPrefix) {
  Warnings warnings;
  const MarkerMapping mapping = ResolveMarkerMapping(
      {{"R Knee", "MARKER_C"}, {"Anna:lfhd", "MARKER_A", 2}, {"gone", "MARKER_B"}},
      LabelsOf(MakeRecording({"other", "LFHD", "r.knee"})), MakeModel(), &warnings);
  ASSERT_EQ(mapping.assignments.size(), 2u);
  EXPECT_EQ(mapping.assignments[0].label, 1);
  EXPECT_EQ(mapping.assignments[0].marker, 0);
  EXPECT_EQ(mapping.assignments[0].noise_scale, 2);
  EXPECT_EQ(mapping.assignments[1].label, 2);
  EXPECT_EQ(mapping.assignments[1].marker, 2);
  EXPECT_THAT(mapping.ignored_labels, ElementsAre("other"));
  EXPECT_THAT(mapping.absent_markers, ElementsAre("MARKER_B"));
  EXPECT_THAT(warnings.texts(), IsEmpty());
}

TEST(MarkerMapping, TakesTheFirstSubstituteThatIsSeen) {
  Warnings warnings;
  const MarkerMapping mapping = ResolveMarkerMapping(
      {{"X1", "MARKER_A"},
       {"TIB", "MARKER_A", 3, "worn anywhere"},
       {"SHN", "MARKER_A", 3},
       {"X2", "MARKER_B"}},
      LabelsOf(MakeRecording({"X1", "SHN", "TIB", "X2"})), MakeModel(), &warnings);
  ASSERT_EQ(mapping.assignments.size(), 1u);
  EXPECT_EQ(mapping.assignments[0].label, 2);
  EXPECT_THAT(mapping.ignored_labels, ElementsAre("X1", "SHN", "X2"));
  EXPECT_THAT(mapping.absent_markers, ElementsAre("MARKER_B"));
  EXPECT_THAT(warnings.texts(),
              ElementsAre(HasSubstr("X1 is not seen"), HasSubstr("TIB as MARKER_A: worn anywhere"),
                          HasSubstr("X2 is not seen")));
}

TEST(MarkerMapping, OfAStreamTakesTheFirstSubstitute) {
  Warnings warnings;
  const MarkerMapping mapping =
      ResolveMarkerMapping({{"X1", "MARKER_A"}, {"TIB", "MARKER_A", 3}, {"X2", "MARKER_B"}},
                           {{"X1", "TIB", "X2"}, {}, {}}, MakeModel(), &warnings);
  EXPECT_THAT(LabelIndices(mapping.assignments), ElementsAre(0, 2));
  EXPECT_THAT(MarkerIndices(mapping.assignments), ElementsAre(0, 1));
  EXPECT_THAT(NoiseScales(mapping.assignments), ElementsAre(1, 1));
  EXPECT_TRUE(warnings.empty());
}

TEST(MarkerMapping, LabelsOfARecordingAreThoseSeenInSomeFrame) {
  const MarkerLabels labels = LabelsOf(MakeRecording({"A", "X1", "B"}), "walk.c3d");
  EXPECT_THAT(labels.names, ElementsAre("A", "X1", "B"));
  EXPECT_THAT(labels.seen, ElementsAre(true, false, true));
  EXPECT_EQ(labels.source, "walk.c3d");
}

TEST(MarkerMapping, SaysWhatDoesNotMatch) {
  EXPECT_THAT(MessageOf({{"C7", "MARKER_A"}, {"T10", "MARKER_B"}}, MakeRecording({"foo", "bar"})),
              AllOf(HasSubstr("walk.c3d: no label"), HasSubstr("foo, bar"), HasSubstr("C7, T10")));
  EXPECT_THAT(MessageOf({}, MakeRecording({"foo"})), HasSubstr("the mapping has none"));
  EXPECT_THAT(MessageOf({{"C7", "MARKER_Z"}}, MakeRecording({"C7"})),
              AllOf(HasSubstr("not markers of model mmm: MARKER_Z"), HasSubstr("MARKER_D")));
  EXPECT_THAT(MessageOf({{"C7", "MARKER_A"}, {"c7", "MARKER_B"}}, MakeRecording({"C7"})),
              HasSubstr("c7 is mapped to both MARKER_A and MARKER_B"));
}

}  // namespace
}  // namespace mmm_converter
