// SPDX-License-Identifier: MIT
#include "common/support/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace mmm_converter {
namespace {

TEST(ParallelFor, CallsEachIndexOnceWhateverTheJobs) {
  for (const int jobs : {0, 1, 2, 7}) {
    std::vector<std::atomic<int>> calls(100);
    ParallelFor(100, jobs, [&](int i) { ++calls[i]; });
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1) << jobs;
  }
}

TEST(ParallelFor, DoesNothingForNothing) {
  ParallelFor(0, 4, [](int) { FAIL(); });
}

TEST(ParallelFor, RunsNoMoreJobsAtATimeThanAllowed) {
  std::atomic<int> running = 0;
  std::atomic<int> most = 0;
  ParallelFor(200, 2, [&](int) {
    const int now = ++running;
    int seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
    --running;
  });
  EXPECT_LE(most, 2);
}

TEST(ParallelFor, ThrowsWhatABodyThrows) {
  for (const int jobs : {1, 3}) {
    EXPECT_THROW(ParallelFor(10, jobs,
                             [](int i) {
                               if (i == 5) throw std::runtime_error("5");
                             }),
                 std::runtime_error);
  }
  EXPECT_GE(DefaultJobs(), 1);
}

}  // namespace
}  // namespace mmm_converter
