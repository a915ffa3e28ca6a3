// SPDX-License-Identifier: MIT
#include "common/label/track/point_tracks.h"

#include <gtest/gtest.h>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

// Three points on lines at 100 Hz; the columns of the first two change places at frame 5.
MarkerSequence Lines() {
  MarkerSequence points({"*1", "*2", "*3"}, 10, 100, 0);
  for (int k = 0; k < 10; ++k) {
    const bool is_changed = k >= 5;
    points.frame(k).col(is_changed ? 1 : 0) << 0.01 * k, 0, 0;
    points.frame(k).col(is_changed ? 0 : 1) << 0.01 * k, 0.3, 0;
    points.frame(k).col(2) << 0, -0.01 * k, 1;
  }
  return points;
}

TEST(PointTracksTest, ThingsAreFollowedWhateverTheirColumns) {
  const PointTracks followed = FollowPoints(Lines());
  ASSERT_EQ(followed.tracks.size(), 3U);
  for (const PointTrack& track : followed.tracks) {
    EXPECT_EQ(track.begin, 0);
    EXPECT_EQ(track.end, 10);
    for (int k = 1; k < 10; ++k) {
      const Eigen::Vector3d before = followed.frames[k - 1].p_WP.col(track.points[k - 1]);
      EXPECT_NEAR((followed.frames[k].p_WP.col(track.points[k]) - before).norm(), 0.01, 1e-12);
    }
  }
}

TEST(PointTracksTest, TracksEndAtGapsAndJumps) {
  MarkerSequence points = Lines();
  points.frame(3).col(0).setConstant(kNaN);  // the first one
  for (int k = 7; k < 10; ++k) points.frame(k).col(2).x() += 0.05;
  const PointTracks followed = FollowPoints(points);
  EXPECT_EQ(followed.frames[3].columns, (std::vector<int>{1, 2}));
  EXPECT_EQ(followed.tracks.size(), 6U);  // the neighbour of what jumps is in doubt once
}

TEST(PointTracksTest, ADoubtfulStepIsNotTaken) {
  // Two points come as near to each other as they move in a frame, and part again.
  MarkerSequence points({"*1", "*2"}, 21, 100, 0);
  for (int k = 0; k <= 20; ++k) {
    points.frame(k).col(0) << 0.01 * (k - 10), 0.002, 0;
    points.frame(k).col(1) << 0.01 * (10 - k), -0.002, 0;
  }
  EXPECT_GT(FollowPoints(points).tracks.size(), 2U);
}

TEST(PointTracksTest, NoPointsNoTracks) {
  const PointTracks followed = FollowPoints(MarkerSequence({"*1"}, 3, 100, 0));
  EXPECT_TRUE(followed.tracks.empty());
  EXPECT_EQ(followed.frames.size(), 3U);
}

}  // namespace
}  // namespace mmm_converter
