// SPDX-License-Identifier: MIT
#include "common/label/track/object_tracks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr int kFrames = 30;

LabelObject Box() {
  LabelObject box{{0, 1, 2, 3}, Eigen::Matrix3Xd(3, 4)};
  box.p_OM << 0, 0.2, 0, 0.1, 0, 0, 0.15, 0.05, 0, 0.03, 0, 0.1;
  return box;
}

// The box slides along x and turns, in columns 2 to 5; two other points go their own ways.
MarkerSequence Recording(int box_from) {
  MarkerSequence recording({"*1", "*2", "*3", "*4", "*5", "*6"}, kFrames, 100, 0);
  for (int k = 0; k < kFrames; ++k) {
    recording.frame(k).col(0) << 1, 0.01 * k, 0;
    recording.frame(k).col(1) << -1, -0.01 * k, 0.5;
    if (k < box_from) continue;
    const Eigen::Matrix3d R(Eigen::AngleAxisd(0.02 * k, Eigen::Vector3d::UnitZ()));
    recording.frame(k).rightCols<4>() =
        (R * Box().p_OM).colwise() + Eigen::Vector3d(0.005 * k, 0, 1);
  }
  return recording;
}

TEST(ObjectTracksTest, TracksOfItsMarkersAreTheObjects) {
  const PointTracks tracks = FollowPoints(Recording(0));
  std::vector<int> frames;
  const TrackNames names =
      FindObjectTracks({Box()}, tracks, 10, [&frames](int k) { frames.push_back(k); });
  ASSERT_EQ(names.markers.size(), 6U);
  for (std::size_t t = 0; t < names.markers.size(); ++t) {
    const int column = tracks.frames[0].columns[tracks.tracks[t].points[0]];
    EXPECT_EQ(names.markers[t], column < 2 ? -1 : 10 + column - 2);
  }
  EXPECT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
}

TEST(ObjectTracksTest, WhatComesLaterIsFound) {
  const PointTracks tracks = FollowPoints(Recording(12));
  const TrackNames names = FindObjectTracks({Box()}, tracks, 0, [](int) {});
  int found = 0;
  for (const int marker : names.markers) found += marker >= 0 ? 1 : 0;
  EXPECT_EQ(found, 4);
}

TEST(ObjectTracksTest, WithoutObjectsNothingIsLookedFor) {
  const PointTracks tracks = FollowPoints(Recording(0));
  const TrackNames names =
      FindObjectTracks({}, tracks, 0, [](int) { throw Error("no frame is to be looked at"); });
  EXPECT_EQ(names.markers, std::vector<int>(tracks.tracks.size(), -1));
}

TEST(ObjectTracksTest, WhoeverIsToldOfFramesMayEndTheSearch) {
  const PointTracks tracks = FollowPoints(Recording(0));
  EXPECT_THROW(FindObjectTracks({Box()}, tracks, 0,
                                [](int k) {
                                  if (k == 3) throw Error("cancelled");
                                }),
               Error);
}

}  // namespace
}  // namespace mmm_converter
