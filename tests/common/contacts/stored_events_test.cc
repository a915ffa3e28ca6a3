// SPDX-License-Identifier: MIT
#include "common/contacts/stored_events.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mmm_converter {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::SizeIs;

TEST(FootEvents, ByManyNames) {
  const auto is = [](const char* label, const char* context, const char* told, Side side) {
    const auto event = FootEventOf({1.5, label, context, "", false});
    ASSERT_TRUE(event) << label;
    EXPECT_EQ(event->time, 1.5);
    EXPECT_STREQ(event->label, told) << label;
    EXPECT_EQ(event->side, side) << label;
  };
  is("Foot Strike", "Left", "Foot Strike", Side::kLeft);
  is("foot off", "Right", "Foot Off", Side::kRight);
  is("RHS", "", "Foot Strike", Side::kRight);
  is("LTO", "", "Foot Off", Side::kLeft);
  is("RIC", "General", "Foot Strike", Side::kRight);
  is("Left Heel Strike", "", "Foot Strike", Side::kLeft);
  is("Toe Off", "Left", "Foot Off", Side::kLeft);
  for (const char* other : {"Event", "Foot Strike", "left", "", "Start"}) {
    EXPECT_FALSE(FootEventOf({1.5, other, "General", "", false})) << other;
  }
}

TEST(FootEvents, OfThePersonAndOfTheHeaderWhereThereAreNoOthers) {
  const std::vector<C3dEvent> all = {{2, "Foot Strike", "Left", "anna", false},
                                     {1, "Foot Strike", "Left", "ben", false},
                                     {1.5, "LTO", "", "", true}};
  EXPECT_THAT(FootEventsOf(all, "anna"), SizeIs(1));
  EXPECT_THAT(FootEventsOf(all, ""), SizeIs(2));
  EXPECT_THAT(FootEventsOf({all[2]}, "anna"), SizeIs(1));
}

/// The left foot stands on plate 1 from 1 to 1.6 s, and off the plates from 2 to 2.6 s.
class StoredEventsTest : public ::testing::Test {
 protected:
  StoredEventsTest() {
    motion_.rate = 100;
    motion_.feet[0].heel.resize(3, 400);
    forces_.rate = 1000;
    forces_.plates.resize(1);
    forces_.plates[0].plate.number = 1;
    PlateLoad load;
    load.begin = 1;
    load.end = 1.6;
    load.bearer = Bearer::kLeft;
    found_.loads = {load};
    FootContact first;
    first.begin = 1;
    first.end = 1.6;
    first.plates = {1};
    FootContact second;
    second.begin = 2;
    second.end = 2.6;
    found_.contacts = {first, second};
  }

  Contacts Told(const std::vector<double>& times,
                EventChoice choice = EventChoice::kWhereComplete) {
    StoredEvents stored;
    stored.choice = choice;
    for (std::size_t i = 0; i < times.size(); ++i) {
      stored.events.push_back({times[i], i % 2 == 0 ? "Foot Strike" : "Foot Off", Side::kLeft});
    }
    notes_.clear();
    return WithStoredEvents(stored, motion_, found_, forces_, &notes_);
  }

  FootMotion motion_;
  RecordedForces forces_;
  Contacts found_;
  std::vector<std::string> notes_;
};

TEST_F(StoredEventsTest, AreTakenWhereTheyAreAll) {
  const Contacts told = Told({1.01, 1.59, 2.03, 2.55});
  ASSERT_THAT(told.contacts, SizeIs(2));
  EXPECT_THAT(told.contacts[0].begin, Optional(1.01));
  EXPECT_THAT(told.contacts[0].plates, ElementsAre(1));
  EXPECT_THAT(told.contacts[1].end, Optional(2.55));
  EXPECT_THAT(told.contacts[1].plates, IsEmpty());
  ASSERT_THAT(notes_, SizeIs(1));
  EXPECT_THAT(notes_[0], HasSubstr("of the left foot are by the file's events"));
}

TEST_F(StoredEventsTest, AreNotTakenWhereSomeAreMissing) {
  const Contacts told = Told({1.01, 1.59});
  EXPECT_THAT(told.contacts[0].begin, Optional(1.0));
  ASSERT_THAT(notes_, SizeIs(1));
  EXPECT_THAT(notes_[0], HasSubstr("2 of 4 events of the left foot"));
}

TEST_F(StoredEventsTest, AreTakenWhereTheUserSaysSo) {
  const Contacts told = Told({1.01, 1.59, 3.0}, EventChoice::kFile);
  ASSERT_THAT(told.contacts, SizeIs(2));
  EXPECT_THAT(told.contacts[1].begin, Optional(3.0));
  EXPECT_FALSE(told.contacts[1].end);
  EXPECT_THAT(Told({1.01, 1.59, 2.03, 2.55}, EventChoice::kFound).contacts[0].begin, Optional(1.0));
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(StoredEventsTest, WhatContradictsAPlateIsNamed) {
  Told({1.045, 1.59, 2.1, 2.55});
  ASSERT_THAT(notes_, SizeIs(2));
  EXPECT_THAT(notes_[0], HasSubstr("more than 40 ms"));
  EXPECT_THAT(notes_[0], HasSubstr("Left Foot Strike at 1.045 s (plate 1: 1.000 s)"));
}

TEST_F(StoredEventsTest, OfTheOtherFootAreToldAndDoNotCount) {
  for (PlateLoad& load : found_.loads) load.bearer = Bearer::kRight;
  for (FootContact& one : found_.contacts) one.side = Side::kRight;
  for (const auto choice : {EventChoice::kFile, EventChoice::kWhereComplete}) {
    const Contacts told = Told({1.01, 1.59, 2.03, 2.55}, choice);
    ASSERT_THAT(told.contacts, SizeIs(2));
    EXPECT_EQ(told.contacts[0].side, Side::kRight);
    EXPECT_THAT(told.contacts[0].begin, Optional(1.0));
    EXPECT_THAT(notes_, ElementsAre(HasSubstr("left and right exchanged: 4 of 4")));
  }
  // Two tell too little, and others may be of steps that are not found.
  EXPECT_THAT(Told({1.01, 1.59}, EventChoice::kFile).contacts[0].begin, Optional(1.01));
  EXPECT_THAT(Told({0.2, 0.8, 1.01, 1.59, 2.03, 2.8, 3.2, 3.8}, EventChoice::kFile).contacts,
              SizeIs(4));
}

TEST_F(StoredEventsTest, OfOtherTimesAreNone) {
  EXPECT_THAT(Told({11, 12}, EventChoice::kFile).contacts, SizeIs(2));
}

}  // namespace
}  // namespace mmm_converter
