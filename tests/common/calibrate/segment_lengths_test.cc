// SPDX-License-Identifier: MIT
#include "common/calibrate/segment_lengths.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "common/model/kit_joints.h"
#include "tests/support/all_indices.h"
#include "tests/support/synthetic_person.h"

namespace mmm_converter {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Not;

std::vector<std::string> Names(const KinematicModel& model, const SegmentLengths& lengths) {
  std::vector<std::string> names;
  for (const int s : lengths.segments) names.push_back(model.segments()[s].name);
  return names;
}

SegmentLengths ReferenceLengths(const KinematicModel& model) {
  const auto markers = testing::AllIndices<MarkerIx>(model.markers().size());
  return FindSegmentLengths(model, testing::TrackedJoints(model), markers);
}

TEST(SegmentLengths, AreWhatSetsTrackedJointsApart) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const std::vector<std::string> names = Names(model, ReferenceLengths(model));
  EXPECT_THAT(names, Contains("LKsegment_joint"));  // thigh
  EXPECT_THAT(names, Contains("RAsegment_joint"));  // shank
  EXPECT_THAT(names, Contains("LEsegment_joint"));  // upper arm
  // Behind the last tracked joint there are only markers.
  EXPECT_THAT(names, AllOf(Not(Contains("Hand L Palm")), Not(Contains("HeadSegment_joint"))));
}

TEST(SegmentLengths, WithoutMarkersBelowThereIsNothingToFind) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const std::vector<MarkerIx> pelvis = {MarkerIx(model.FindMarker("MARKER_LASI")),
                                        MarkerIx(model.FindMarker("MARKER_L3"))};
  const std::vector<std::string> names =
      Names(model, FindSegmentLengths(model, testing::TrackedJoints(model), pelvis));
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("BPSegment_joint", "LHsegment_joint"));
}

TEST(SegmentLengths, KnowLeftFromRight) {
  const KinematicModel model = testing::ScaledReferenceModel(1.7);
  const SegmentLengths lengths = ReferenceLengths(model);
  std::vector<std::string> paired;
  for (const auto& [left, right] : lengths.mirror) {
    const std::string name = model.segments()[lengths.segments[left]].name;
    paired.push_back(name);
    EXPECT_EQ(MirroredName(name), model.segments()[lengths.segments[right]].name);
  }
  EXPECT_THAT(paired, Contains("LKsegment_joint"));
  EXPECT_THAT(paired, Not(Contains("BPSegment_joint")));
  EXPECT_EQ(MirroredName("LeftFoot"), "RightFoot");
  EXPECT_EQ(MirroredName("RKx_joint"), "LKx_joint");
  EXPECT_EQ(MirroredName("Head"), "");
}

}  // namespace
}  // namespace mmm_converter
