// SPDX-License-Identifier: MIT
#include "common/io/tables/row_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "common/support/units.h"

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kHundredths = 0.01;  // [s] resolution

RowPlaces PlaceRowsOf(std::vector<double> frames, std::vector<double> times, double rate,
                      double resolution = kHundredths, Warnings* warnings = nullptr) {
  return PlaceRows({std::move(frames), std::move(times), resolution}, rate, warnings);
}

TEST(RowTimes, KeepAGapThatTimesAndFramesAgreeOn) {
  Warnings warnings;
  const RowPlaces placed =
      PlaceRowsOf({59, 60, 111, 112}, {0.58, 0.59, 1.1, 1.11}, 100, kHundredths, &warnings);
  EXPECT_THAT(placed.places, ElementsAre(0, 1, 52, 53));
  EXPECT_EQ(placed.num_places, 54);
  EXPECT_EQ(placed.rate, 100);
  EXPECT_EQ(placed.first_time, 0.58);
  EXPECT_EQ(placed.first_frame, 59);
  EXPECT_THAT(warnings.texts(),
              ElementsAre(HasSubstr(
                  "50 frames are missing between frames 60 and 111 (0.59 s and 1.1 s): a gap")));
}

TEST(RowTimes, CountWhereFramesAreNumberedAnew) {
  Warnings warnings;
  const RowPlaces gap = PlaceRowsOf({1, 2, 3}, {0, 0.01, 0.05}, 100, kHundredths, &warnings);
  EXPECT_THAT(gap.places, ElementsAre(0, 1, 5));
  const RowPlaces none = PlaceRowsOf({1, 2, 9}, {0, 0.01, 0.02}, 100, kHundredths, &warnings);
  EXPECT_THAT(none.places, ElementsAre(0, 1, 2));
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("3 frames are missing"),
                                            HasSubstr("frame numbers skip or go back 1 times")));
}

TEST(RowTimes, FollowEachOtherWhereTheyGoBack) {
  Warnings warnings;
  const RowPlaces placed =
      PlaceRowsOf({1, 2, 3, 1, 2}, {0.5, 0.51, 0.52, 0, 0.01}, 100, kHundredths, &warnings);
  EXPECT_THAT(placed.places, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(placed.rate, 100);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("time goes from 0.52 s to 0 s")));
}

TEST(RowTimes, AreSaidToGoBackWhereAllDo) {
  const std::vector<double> none(4, kNaN);
  for (const bool by_frames : {true, false}) {
    Warnings warnings;
    const std::vector<double> back = {4, 3, 2, 1};
    PlaceRowsOf(by_frames ? back : none, by_frames ? none : back, 100, 1, &warnings);
    EXPECT_THAT(warnings.texts(), ::testing::Contains(HasSubstr("and 2 more such steps back")));
  }
}

TEST(RowTimes, ATimeThatFitsNoNeighbourIsPassedOver) {
  for (const double odd : {0.0, -3.0, 99.0, kNaN}) {
    Warnings warnings;
    const RowPlaces placed =
        PlaceRowsOf({1, 2, 3, 4}, {0.01, 0.02, odd, 0.04}, 100, kHundredths, &warnings);
    EXPECT_THAT(placed.places, ElementsAre(0, 1, 2, 3)) << odd;
    EXPECT_THAT(warnings.texts(), IsEmpty()) << odd;
  }
}

TEST(RowTimes, ARowThatRepeatsTheOneBeforeIsLeftOut) {
  Warnings warnings;
  const RowPlaces placed =
      PlaceRowsOf({1, 2, 2, 3}, {0, 0.01, 0.01, 0.02}, 100, kHundredths, &warnings);
  EXPECT_THAT(placed.places, ElementsAre(0, 1, -1, 2));
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("1 rows repeat")));
}

// Of 300 Hz with two decimals three rows have the same time, of 60 Hz steps are one or two units.
TEST(RowTimes, RoundedTimesAreNoGaps) {
  for (const double rate : {300.0, 120.0, 60.0, 59.94}) {
    for (const double resolution : {0.01, 0.001}) {
      std::vector<double> frames;
      std::vector<double> times;
      for (int k = 0; k < 2000; ++k) {
        frames.push_back(k + 1);
        times.push_back(std::round(k / rate / resolution) * resolution);
      }
      Warnings warnings;
      const RowPlaces placed = PlaceRowsOf(frames, times, rate, resolution, &warnings);
      EXPECT_EQ(placed.num_places, 2000) << rate << " " << resolution;
      EXPECT_EQ(placed.rate, rate);
      EXPECT_THAT(warnings.texts(), IsEmpty());
    }
  }
}

TEST(RowTimes, AGapBetweenRoundedTimesIsFoundByTheFramesNumber) {
  std::vector<double> frames;
  std::vector<double> times;
  for (int k = 0; k < 200; ++k) {
    const int frame = k < 100 ? k : k + 1;  // one is missing
    frames.push_back(frame + 1);
    times.push_back(std::round(frame / 60.0 * 100) / 100);
  }
  EXPECT_EQ(PlaceRowsOf(frames, times, 60).num_places, 201);
}

TEST(RowTimes, FramesCountWhereThereAreNoTimes) {
  Warnings warnings;
  const std::vector<double> none(4, kNaN);
  const RowPlaces placed = PlaceRowsOf({143, 144, 147, 148}, none, 100, 1, &warnings);
  EXPECT_THAT(placed.places, ElementsAre(0, 1, 4, 5));
  EXPECT_EQ(placed.first_time, 1.42);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("between frames 144 and 147")));
  // Every second frame of a capture, at half its rate.
  EXPECT_THAT(PlaceRowsOf({1, 3, 5, 7}, none, 50, 1).places, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(PlaceRowsOf({1, 2, 3, 4}, none, kNaN, 1).rate, 0);
}

TEST(RowTimes, OverruleARateThatIsWrong) {
  Warnings warnings;
  const RowPlaces placed =
      PlaceRowsOf({1, 2, 3, 4}, {0, 0.02, 0.04, 0.06}, 100, kHundredths, &warnings);
  EXPECT_DOUBLE_EQ(placed.rate, 50);
  EXPECT_EQ(placed.num_places, 4);
  EXPECT_THAT(warnings.texts(), ElementsAre(HasSubstr("the file says 100 Hz")));
}

TEST(RowTimes, HugeAndBrokenNumbersStayInBounds) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> odd = {0, 1e300, -1e300, inf, kNaN, 1, 1e15, 2};
  const RowPlaces placed = PlaceRowsOf(odd, {odd.rbegin(), odd.rend()}, 100);
  EXPECT_LE(placed.num_places, std::int64_t{1000000000000100});
  for (std::size_t k = 1; k < placed.places.size(); ++k) {
    EXPECT_TRUE(placed.places[k] < 0 || placed.places[k] > placed.places[k - 1]) << k;
  }
}

}  // namespace
}  // namespace mmm_converter
