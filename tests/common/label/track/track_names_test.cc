// SPDX-License-Identifier: MIT
#include "common/label/track/track_names.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

PointTracks Tracks(const std::vector<std::pair<int, int>>& frames) {
  PointTracks tracks;
  tracks.frames.resize(100);
  for (const auto& [begin, end] : frames) {
    tracks.tracks.push_back({begin, end, std::vector<int>(static_cast<std::size_t>(end - begin))});
  }
  return tracks;
}

TEST(TrackNamesTest, ATrackIsWhatItHasMostVotesFor) {
  const TrackNames names = ResolveVotes({{{0, 20}, {1, 60}}}, Tracks({{0, 100}}), 2, 0.25);
  EXPECT_EQ(names.markers, std::vector<int>{1});
  EXPECT_DOUBLE_EQ(names.shares[0], 0.6);
}

TEST(TrackNamesTest, AShareOfNoMoreThanTheLeastGivesNoName) {
  const TrackNames names =
      ResolveVotes({{{0, 25}}, {{1, 26}}}, Tracks({{0, 100}, {0, 100}}), 2, 0.25);
  EXPECT_EQ(names.markers, (std::vector<int>{-1, 1}));
  EXPECT_EQ(names.shares[0], 0);
}

TEST(TrackNamesTest, ANameIsNotGivenTwiceInAFrame) {
  // The second has more votes; the first takes what is left to it.
  const TrackVotes votes = {{{0, 50}, {1, 30}}, {{0, 90}}, {{0, 10}}};
  const TrackNames names = ResolveVotes(votes, Tracks({{0, 60}, {0, 90}, {90, 100}}), 2, 0.25);
  EXPECT_EQ(names.markers, (std::vector<int>{1, 0, 0}));
  EXPECT_DOUBLE_EQ(names.shares[0], 0.5);
}

TEST(TrackNamesTest, OfAsManyVotesTheFirstTrackIsFirst) {
  const TrackNames names =
      ResolveVotes({{{0, 50}}, {{0, 50}}}, Tracks({{0, 100}, {0, 100}}), 1, 0.25);
  EXPECT_EQ(names.markers, (std::vector<int>{0, -1}));
}

}  // namespace
}  // namespace mmm_converter
