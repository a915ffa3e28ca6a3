// SPDX-License-Identifier: MIT
#include "common/pipeline/input/trunk_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/convert/converter_config.h"
#include "common/convert/marker_mapping.h"
#include "common/math/up_axis.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The sample's begin, where the person stands, as if the file stated z and labels of the head and
/// the feet had said y; truly: the axis that is up in the file.
Input Contradicted(UpAxis truly) {
  InputRequest request;
  request.file = MMM_CONVERTER_SOURCE_DIR "/examples/handstand.c3d";
  request.end_frame = 30;
  Warnings unused;
  Input input = ReadInput(request, {}, &unused);
  Recording& recording = input.recording;
  const Eigen::Matrix3d turn = RotationToZUp(UpAxis::kY) * RotationToZUp(truly).transpose();
  for (int k = 0; k < recording.markers.num_frames(); ++k) {
    recording.markers.frame(k) = (turn * recording.markers.frame(k)).eval();
  }
  recording.stated_up_axis = UpAxis::kZ;
  recording.up_axis = UpAxis::kY;
  recording.up_axis_was_decided = true;
  recording.doubts = {{"y is taken", Remedy::kUpAxis}};
  return input;
}

Input Decide(UpAxis truly, Warnings* warnings) {
  Input input = Contradicted(truly);
  Warnings unused;
  const TrackingSetup setup =
      MatchMarkers(LabelsOf(input.recording.markers), input.reference, ConverterConfig(), &unused);
  LetTrunkDecideUpAxis(setup, &input, warnings);
  return input;
}

TEST(TrunkAxis, TheFileIsRightWhereTheTrunkStandsByIt) {
  Warnings warnings;
  const Input input = Decide(UpAxis::kZ, &warnings);
  EXPECT_EQ(input.recording.up_axis, UpAxis::kZ);
  EXPECT_TRUE(input.recording.doubts.empty());
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("+z is taken after all")));
  const MarkerSequence& markers = input.recording.markers;
  EXPECT_GT(markers.frame(0)(2, markers.FindLabel("C7")),
            markers.frame(0)(2, markers.FindLabel("LHEE")) + 1);
}

TEST(TrunkAxis, TheLabelsAreRightWhereItDoesNot) {
  Warnings warnings;
  const Input input = Decide(UpAxis::kY, &warnings);
  EXPECT_EQ(input.recording.up_axis, UpAxis::kY);
  EXPECT_EQ(input.recording.doubts.size(), 1U);
  EXPECT_TRUE(warnings.texts().empty());
}

}  // namespace
}  // namespace mmm_converter
