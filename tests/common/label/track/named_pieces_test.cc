// SPDX-License-Identifier: MIT
#include "common/label/track/named_pieces.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

// One track of ten frames, in column 0 and from frame 6 on in column 1; another in column 2 all
// the time.
PointTracks TwoTracks() {
  PointTracks tracks;
  for (int k = 0; k < 10; ++k) {
    FramePoints points;
    points.p_WP.setZero(3, 2);
    points.columns = {k < 6 ? 0 : 1, 2};
    points.tracks = {0, 1};
    tracks.frames.push_back(points);
  }
  tracks.tracks = {{0, 10, std::vector<int>(10, 0)}, {0, 10, std::vector<int>(10, 1)}};
  return tracks;
}

TEST(NamedPiecesTest, APieceIsOfOnePointAndOneName) {
  const auto pieces = PiecesOf(TwoTracks(), {{1, -1}, {0.9, 0}}, {{-1, -1, -1}, {7, 8}}, {});
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[0].point, 0);
  EXPECT_EQ(pieces[0].end, 6);
  EXPECT_EQ(pieces[0].name, 8);
  EXPECT_DOUBLE_EQ(pieces[0].probability, 0.9);
  EXPECT_EQ(pieces[1].point, 1);
  EXPECT_EQ(pieces[1].begin, 6);
  EXPECT_EQ(pieces[1].name, 8);
  EXPECT_EQ(pieces[2].point, 2);
  EXPECT_EQ(pieces[2].name, -1);
  EXPECT_DOUBLE_EQ(pieces[2].probability, 1);
}

TEST(NamedPiecesTest, WhatIsNotSureHasNoName) {
  const TrackNames found = {{1, 0}, {0.39, 0.41}};
  const auto pieces = PiecesOf(TwoTracks(), found, {{-1, -1, -1}, {7, 8}}, {});
  EXPECT_EQ(pieces[0].name, -1);
  EXPECT_DOUBLE_EQ(pieces[0].probability, 1 - 0.39);
  EXPECT_EQ(pieces[2].name, 7);
}

TEST(NamedPiecesTest, AStoredLabelStaysUnlessAnotherIsSurer) {
  const MarkerColumns columns = {{0, 0, -1}, {7, 8}};
  EXPECT_EQ(PiecesOf(TwoTracks(), {{1, -1}, {0.79, 0}}, columns, {})[0].name, 7);
  EXPECT_EQ(PiecesOf(TwoTracks(), {{1, -1}, {0.8, 0}}, columns, {})[0].name, 8);
}

TEST(NamedPiecesTest, AStoredLabelYieldsToWhomItIsFoundFor) {
  // Stored for the first track, found for the second: the first has no name there.
  const MarkerColumns columns = {{0, 0, -1}, {7, 8}};
  const auto pieces = PiecesOf(TwoTracks(), {{-1, 0}, {0, 0.9}}, columns, {});
  EXPECT_EQ(pieces[0].name, -1);
  EXPECT_EQ(pieces.back().name, 7);
}

}  // namespace
}  // namespace mmm_converter
