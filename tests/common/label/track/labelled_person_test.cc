// SPDX-License-Identifier: MIT
#include "common/label/track/labelled_person.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/math/seeded_random.h"
#include "tests/common/label/made_person.h"

namespace mmm_converter::testing {
namespace {

/// A person by height alone, all of whose points are theirs.
class LabelledPersonTest : public ::testing::Test {
 protected:
  LabelledPersonTest()
      : made_(71, 4),
        tracks_(FollowPoints(made_.recording)),
        person_(made_.setup, kFirst, tracks_, 1 / made_.recording.rate()) {}

  void Offer(int k) {
    person_.offered.resize(static_cast<std::size_t>(tracks_.frames[k].p_WP.cols()));
    std::iota(person_.offered.begin(), person_.offered.end(), 0);
    person_.points = tracks_.frames[k].p_WP;
    person_.hints = {};
  }

  BodyMatch MatchAt(int k) const {
    BodyMatch match;
    match.posture = made_.PostureAt(k);
    return match;
  }

  // Names that are right and sure.
  TrackNames TrueNames() const {
    TrackNames names;
    for (const PointTrack& track : tracks_.tracks) {
      const int column = tracks_.frames[track.begin].columns[track.points[0]];
      names.markers.push_back(kFirst + column);
      names.shares.push_back(1);
    }
    return names;
  }

  static constexpr int kFirst = 100;
  MadePerson made_;
  PointTracks tracks_;
  LabelledPerson person_;
};

TEST_F(LabelledPersonTest, MarkersAreCountedFromTheFirst) {
  EXPECT_FALSE(person_.IsMarker(kFirst - 1));
  EXPECT_TRUE(person_.IsMarker(kFirst));
  EXPECT_TRUE(person_.IsMarker(kFirst + made_.body.num_markers() - 1));
  EXPECT_FALSE(person_.IsMarker(kFirst + made_.body.num_markers()));
  EXPECT_FALSE(person_.was_calibrated());
}

TEST_F(LabelledPersonTest, FollowGivesThePointsThatWereOffered) {
  person_.Start(MatchAt(0));
  for (int k = 0; k < 20; ++k) {
    Offer(k);
    EXPECT_EQ(CountOwn(person_.Follow()), made_.body.num_markers()) << "frame " << k;
  }
}

// From the wrong posture, with no point in its place, the body is found after half a second.
TEST_F(LabelledPersonTest, ABodyThatIsLostIsFoundAnew) {
  BodyMatch wrong = MatchAt(0);
  wrong.posture.position += Eigen::Vector3d(3, 2, 0);
  person_.Start(wrong);
  int own = 0;
  for (int k = 0; k < 60; ++k) {
    Offer(k);
    own = CountOwn(person_.Follow());
    if (k == 45) {
      EXPECT_LT(own, made_.body.num_markers() / 2);
    }
  }
  EXPECT_EQ(own, made_.body.num_markers());
}

TEST_F(LabelledPersonTest, AmongNoiseTheBodyIsNotSearchedForAllAlong) {
  person_.Start(MatchAt(0));
  SeededRandom random(72);
  person_.set_searches({3, 3});
  for (int k = 0; k < 120; ++k) {  // 1.2 s: one more search, and no second one
    Offer(0);
    for (double& x : person_.points.reshaped()) x = 4 * random.Uniform();
    person_.Follow();
  }
  EXPECT_EQ(person_.searches().vain, 4);
  EXPECT_EQ(person_.searches().made, 4);
}

// As where a unit is wrong. Nothing fits better than what is followed, and nothing fits.
TEST_F(LabelledPersonTest, AmongPointsOfALargerBodyTheSearchesAreFew) {
  person_.Start(MatchAt(0));
  for (int k = 0; k < 600; ++k) {
    Offer(0);
    person_.points *= 1.3;
    person_.Follow();
  }
  EXPECT_LE(person_.searches().made, 9);
}

// What is found is lost again and again: a search for each of the four seconds, and four.
TEST_F(LabelledPersonTest, ABodyThatJumpsAboutIsNotSearchedForAllAlong) {
  person_.Start(MatchAt(0));
  for (int k = 0; k < 1000; ++k) {
    Offer(0);
    person_.points.colwise() += Eigen::Vector3d(k / 55 % 2 * 3.0, 0, 0);
    person_.Follow();
  }
  EXPECT_LE(person_.searches().made, 9);
  EXPECT_EQ(person_.searches().vain, 0);
}

TEST_F(LabelledPersonTest, AHeightIsCalibratedOnceOnSureNames) {
  person_.Start(MatchAt(0));
  const double before = person_.body().place.mean();
  TrackNames unsure = TrueNames();
  unsure.shares.assign(unsure.shares.size(), 0.69);
  EXPECT_FALSE(person_.Calibrate(unsure));
  EXPECT_TRUE(person_.Calibrate(TrueNames()));
  EXPECT_LT(person_.body().place.mean(), 0.5 * before);
  EXPECT_FALSE(person_.Calibrate(TrueNames()));
}

}  // namespace
}  // namespace mmm_converter::testing
