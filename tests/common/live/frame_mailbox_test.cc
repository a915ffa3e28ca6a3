// SPDX-License-Identifier: MIT
#include "common/live/frame_mailbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace mmm_converter {
namespace {

using std::chrono::milliseconds;

void Put(std::int64_t number, FrameMailbox* box) {
  box->next().frame.number = number;
  box->Put();
}

TEST(FrameMailbox, TheNewestFrameWinsAndTheOthersAreCounted) {
  FrameMailbox box(false);
  EXPECT_EQ(box.Take(milliseconds(0), 1), nullptr);
  for (int k = 1; k <= 5; ++k) Put(k, &box);
  const LaidOutFrame* frame = box.Take(milliseconds(0), 1);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->frame.number, 5);
  EXPECT_EQ(box.dropped(), 4);
  EXPECT_EQ(box.Take(milliseconds(0), 1), nullptr);
}

TEST(FrameMailbox, WhatWasTakenStaysWhileOthersCome) {
  FrameMailbox box(false);
  Put(1, &box);
  const LaidOutFrame* frame = box.Take(milliseconds(0), 1);
  ASSERT_NE(frame, nullptr);
  for (int k = 2; k <= 9; ++k) Put(k, &box);
  EXPECT_EQ(frame->frame.number, 1);
}

TEST(FrameMailbox, LastFrameIsThereAfterTheEnd) {
  FrameMailbox box(false);
  Put(1, &box);
  box.Close();
  ASSERT_NE(box.Take(milliseconds(0), 1), nullptr);
  EXPECT_EQ(box.Take(milliseconds(60000), 1), nullptr);
  EXPECT_TRUE(box.is_closed());
}

TEST(FrameMailbox, NoFrameIsDroppedWhereAllAreKept) {
  FrameMailbox box(true);
  constexpr int kFrames = 20000;
  std::thread reader([&] {
    for (int k = 1; k <= kFrames; ++k) Put(k, &box);
    box.Close();
  });
  std::int64_t last = 0;
  bool is_in_order = true;
  while (true) {
    const LaidOutFrame* frame = box.Take(milliseconds(1000), 1);
    if (frame == nullptr && box.is_closed()) break;
    if (frame == nullptr) continue;
    is_in_order = is_in_order && frame->frame.number == last + 1;
    last = frame->frame.number;
  }
  reader.join();
  EXPECT_TRUE(is_in_order);
  EXPECT_EQ(last, kFrames);
  EXPECT_EQ(box.dropped(), 0);
}

TEST(FrameMailbox, AWriterThatWaitsCanBeSentOn) {
  FrameMailbox box(true);
  box.StopWaiting();
  Put(1, &box);
  Put(2, &box);
  EXPECT_EQ(box.Take(milliseconds(0), 1)->frame.number, 2);
  EXPECT_EQ(box.dropped(), 1);
}

TEST(FrameMailbox, FramesThatCameMeanwhileCanBeTakenInOrder) {
  FrameMailbox box(false);
  for (int k = 1; k <= 4; ++k) Put(k, &box);
  EXPECT_EQ(box.Take(milliseconds(0), FrameMailbox::kRoom)->frame.number, 1);
  EXPECT_EQ(box.Take(milliseconds(0), FrameMailbox::kRoom)->frame.number, 2);
  EXPECT_EQ(box.dropped(), 0);
  EXPECT_FALSE(box.is_empty());
  EXPECT_EQ(box.Take(milliseconds(0), 1)->frame.number, 4);
  EXPECT_TRUE(box.is_empty());
  EXPECT_EQ(box.dropped(), 1);
}

TEST(FrameMailbox, AsManyAsCanBeAffordedAreTakenInOrder) {
  FrameMailbox box(false);
  for (int k = 1; k <= 3; ++k) Put(k, &box);
  EXPECT_EQ(box.Take(milliseconds(0), 3)->frame.number, 1);
  for (int k = 4; k <= 5; ++k) Put(k, &box);
  EXPECT_EQ(box.Take(milliseconds(0), 3)->frame.number, 5);
  EXPECT_EQ(box.dropped(), 3);
}

TEST(FrameMailbox, OfMoreThanThereIsRoomForTheOldestGiveWay) {
  FrameMailbox box(false);
  constexpr int kFrames = 3 * FrameMailbox::kRoom + 5;
  for (int k = 1; k <= kFrames; ++k) Put(k, &box);
  EXPECT_EQ(box.Take(milliseconds(0), FrameMailbox::kRoom)->frame.number,
            kFrames - FrameMailbox::kRoom + 1);
  EXPECT_EQ(box.dropped(), kFrames - FrameMailbox::kRoom);
  EXPECT_EQ(box.Take(milliseconds(0), 1)->frame.number, kFrames);
  EXPECT_EQ(box.dropped(), kFrames - 2);
}

TEST(FrameMailbox, EveryFrameIsTakenOrCounted) {
  FrameMailbox box(false);
  constexpr int kFrames = 200000;
  std::thread reader([&] {
    for (int k = 1; k <= kFrames; ++k) Put(k, &box);
    box.Close();
  });
  std::int64_t last = 0, taken = 0;
  bool is_in_order = true;
  while (!box.is_closed() || !box.is_empty()) {
    const LaidOutFrame* frame = box.Take(milliseconds(1), taken % 3 == 0 ? 1 : FrameMailbox::kRoom);
    if (frame == nullptr) continue;
    is_in_order = is_in_order && frame->frame.number > last;
    last = frame->frame.number;
    ++taken;
  }
  reader.join();
  EXPECT_TRUE(is_in_order);
  EXPECT_EQ(last, kFrames);
  EXPECT_EQ(taken + box.dropped(), kFrames);
}

}  // namespace
}  // namespace mmm_converter
