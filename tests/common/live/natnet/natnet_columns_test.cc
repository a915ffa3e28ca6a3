// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/bytes/file_content.h"
#include "tests/common/live/natnet/natnet_samples.h"
#include "tests/support/shared_data.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using testing::MarkerId;

/// "x y z" of a column; "-": not seen.
std::string At(const Eigen::Matrix3Xd& points, int column) {
  if (!points.col(column).allFinite()) return "-";
  return std::to_string(static_cast<int>(points(0, column))) + " " +
         std::to_string(static_cast<int>(points(1, column))) + " " +
         std::to_string(static_cast<int>(points(2, column)));
}

TEST(NatNetColumns, AssetsTakeTheNamesOfTheirMarkerSets) {
  const NatNetColumns columns(testing::SampleNatNetModel(), {4, 1});
  EXPECT_THAT(columns.labels(), ElementsAre("M1", "M2", "LFHD", "RFHD", "G1", "G2"));
  Eigen::Matrix3Xd points;
  const NatNetColumns::Rest rest = columns.Fill(testing::SampleNatNetFrame(), &points);
  EXPECT_EQ(rest.unnamed, 1);
  EXPECT_FALSE(rest.has_new_asset);
  ASSERT_EQ(points.cols(), 6);
  EXPECT_EQ(At(points, 0), "-");      // filled from the model
  EXPECT_EQ(At(points, 1), "7 8 9");  // filled, but solved
  EXPECT_EQ(At(points, 2), "1 2 3");
  EXPECT_EQ(At(points, 3), "-");      // occluded
  EXPECT_EQ(At(points, 4), "0 0 0");  // 0.5: of the asset's own list
  EXPECT_DOUBLE_EQ(points(0, 4), 0.5);
  EXPECT_EQ(At(points, 5), "-");  // not in the list
}

TEST(NatNetColumns, BeforeTheIdsTellMarkerSetsDo) {
  const NatNetColumns columns(testing::SampleNatNetModel(), {2, 7});
  EXPECT_THAT(columns.labels(), ElementsAre("LFHD", "RFHD", "M1", "M2"));
  Eigen::Matrix3Xd points;
  EXPECT_EQ(columns.Fill(testing::SampleNatNetFrame(), &points).unnamed, 1);
  EXPECT_EQ(At(points, 0), "1 2 3");
  EXPECT_EQ(At(points, 1), "-");  // at the origin
  EXPECT_EQ(At(points, 3), "7 8 9");
}

TEST(NatNetColumns, NamesOfSeveralAssetsStandBehindTheirs) {
  NatNetModel model;
  model.marker_sets = {{"Anna", {"LFHD", "C7"}}, {"Ben", {"LFHD", "T10"}}, {"Loose", {"T10"}}};
  model.skeletons = {{"Anna", 1, {}}, {"Ben", 2, {}}};
  const NatNetColumns columns(model, {3, 1});
  EXPECT_THAT(columns.labels(), ElementsAre("Anna:LFHD", "C7", "Ben:LFHD", "Ben:T10", "Loose:T10"));
}

TEST(NatNetColumns, TheSameNameTwiceInAnAsset) {
  NatNetModel model;
  model.marker_sets = {{"Anna", {"C7", "C7"}}};
  EXPECT_THAT(NatNetColumns(model, {3, 0}).labels(), ElementsAre("C7", "C7_2"));
}

TEST(NatNetColumns, BodiesWithoutAMarkerSetAndAssetsThatTheModelLacks) {
  NatNetModel model;
  model.bodies = {{"Wand", 4, -1, {}, {}, {{{}, 0, ""}, {{}, 0, "Tip"}}}};
  const NatNetColumns columns(model, {4, 0});
  EXPECT_THAT(columns.labels(), ElementsAre("Wand_1", "Tip"));
  NatNetFrame frame;
  frame.markers = {{MarkerId(4, 2), {1, 1, 1}, 0, 10, 0},
                   {MarkerId(4, 3), {1, 1, 1}, 0, 10, 0},
                   {MarkerId(6, 1), {1, 1, 1}, 0, 10, 0}};
  Eigen::Matrix3Xd points;
  const NatNetColumns::Rest rest = columns.Fill(frame, &points);
  EXPECT_EQ(rest.unnamed, 1);
  EXPECT_TRUE(rest.has_new_asset);
  EXPECT_EQ(At(points, 1), "1 1 1");
}

TEST(NatNetColumnsRealFiles, OccludedFrameOfMotive) {
  MMM_CONVERTER_NEEDS_SHARED_DATA();
  NatNetModel model;
  model.bodies = {{"FakeTree", 7, -1, {}, {}, {}}};
  model.marker_sets = {{"FakeTree", {"Marker1", "Marker2", "Marker3", "Marker4", "Marker5"}}};
  const std::string bytes =
      ReadFileContent(testing::SharedData("live/natnet_3.0/mocapframe_packet_occluded_v3.bin"));
  NatNetFrame frame;
  ParseNatNetFrame(ParseNatNetMessage(bytes).payload, {3, 0}, &frame);
  Eigen::Matrix3Xd points;
  const NatNetColumns::Rest rest = NatNetColumns(model, {3, 0}).Fill(frame, &points);
  EXPECT_EQ(rest.unnamed, 0);
  ASSERT_EQ(points.cols(), 5);
  EXPECT_EQ(At(points, 0), "-");  // not in the list
  EXPECT_EQ(At(points, 1), "-");  // occluded
  EXPECT_NEAR(points(0, 2), -0.1203, 1e-4);
  EXPECT_TRUE(points.rightCols(3).allFinite());
}

}  // namespace
}  // namespace mmm_converter
