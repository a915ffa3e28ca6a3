// SPDX-License-Identifier: MIT
#include "common/label/track/worn_elsewhere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mmm_converter {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr double kDt = 0.01;
constexpr double kReach = 0.2;
const Vector3d kWorn(0.03, 0.1, -0.02);

// A link that swings by 0.3 m at 1 Hz.
Vector3d LinkAt(int frame) { return {0.3 * std::sin(2 * std::numbers::pi * frame * kDt), 0, 1}; }

void AddWorn(int marker, int track, const Vector3d& worn, int begin, int end,
             WornElsewhere* elsewhere) {
  for (int k = begin; k < end; ++k) elsewhere->Add(marker, track, worn, LinkAt(k) + worn);
}

TEST(WornElsewhereTest, APointThatStaysOnAMovingLinkIsTheMarker) {
  WornElsewhere elsewhere;
  AddWorn(4, 7, kWorn, 0, 150, &elsewhere);
  EXPECT_THAT(elsewhere.Find(kDt, kReach), ElementsAre(Pair(4, 7)));
}

TEST(WornElsewhereTest, PiecesOfAPathCountTogether) {
  WornElsewhere elsewhere;
  AddWorn(4, 7, kWorn, 0, 60, &elsewhere);
  AddWorn(4, 8, kWorn + Vector3d(0.01, 0, 0), 70, 130, &elsewhere);
  AddWorn(4, 9, kWorn + Vector3d(0.06, 0, 0), 130, 190, &elsewhere);
  EXPECT_THAT(elsewhere.Find(kDt, kReach), UnorderedElementsAre(Pair(4, 7), Pair(4, 8)));
}

TEST(WornElsewhereTest, ATrackIsOneMarkersAtMostTheNearers) {
  WornElsewhere elsewhere;
  AddWorn(4, 7, kWorn, 0, 150, &elsewhere);
  AddWorn(5, 7, kWorn / 2, 0, 150, &elsewhere);
  EXPECT_THAT(elsewhere.Find(kDt, kReach), ElementsAre(Pair(5, 7)));
}

TEST(WornElsewhereTest, WhatDoesNotMoveWithTheLinkIsNot) {
  WornElsewhere elsewhere;
  const Vector3d still = LinkAt(0) + kWorn;
  for (int k = 0; k < 300; ++k) elsewhere.Add(4, 7, still - LinkAt(k), still);
  EXPECT_THAT(elsewhere.Find(kDt, kReach), IsEmpty());
}

TEST(WornElsewhereTest, NothingIsKnownOfALinkThatStands) {
  WornElsewhere elsewhere;
  for (int k = 0; k < 300; ++k) {
    const Vector3d sway(0.002 * std::sin(k), 0, 0);
    elsewhere.Add(4, 7, kWorn + sway, LinkAt(0) + kWorn);
  }
  EXPECT_THAT(elsewhere.Find(kDt, kReach), IsEmpty());
}

TEST(WornElsewhereTest, WhatIsShortOrFarIsNot) {
  WornElsewhere elsewhere;
  AddWorn(4, 7, kWorn, 0, 90, &elsewhere);
  AddWorn(5, 8, {0, 0.25, 0}, 0, 150, &elsewhere);
  EXPECT_THAT(elsewhere.Find(kDt, kReach), IsEmpty());
}

}  // namespace
}  // namespace mmm_converter
