// SPDX-License-Identifier: MIT
#include "common/live/connected_source.h"

#include <gtest/gtest.h>

namespace mmm_converter {
namespace {

/// Gives frames of the numbers that it is told.
class NumberedSource : public ConnectedSource {
 public:
  NumberedSource() : ConnectedSource([] { return SteadyTime(); }) {}

  std::int64_t LostAfter(std::initializer_list<std::int64_t> numbers) {
    for (const std::int64_t number : numbers) CountFrame(number);
    return counts().lost;
  }
  using ConnectedSource::CountConnection;

 private:
  Event Connect() override { return std::nullopt; }
  Event Advance(StreamFrame*) override { return std::nullopt; }
  Event FillFrame(StreamFrame*) override { return std::nullopt; }
  void Wait(std::chrono::nanoseconds) override {}
  void Disconnect() override {}
  std::string Server() const override { return "server"; }
};

TEST(ConnectedSource, CountsFramesThatNeverCame) {
  NumberedSource source;
  EXPECT_EQ(source.LostAfter({100}), 0);  // the first says nothing of those before it
  EXPECT_EQ(source.LostAfter({101, 104}), 2);
  EXPECT_EQ(source.LostAfter({102, 105}), 2);  // one came late, which makes no gap after it
  EXPECT_EQ(source.counts().frames, 5);
}

TEST(ConnectedSource, NumbersMayBeginAnew) {
  NumberedSource source;
  EXPECT_EQ(source.LostAfter({5000, 1, 2, 4}), 1);
  EXPECT_EQ(source.LostAfter({9'000'000, 9'000'002}), 2);
  source.CountConnection();
  EXPECT_EQ(source.LostAfter({9'000'100}), 2);
}

}  // namespace
}  // namespace mmm_converter
