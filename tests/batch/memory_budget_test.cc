// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/batch/memory_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

TEST(MemoryBudget, IsNeverExceeded) {
  constexpr std::uint64_t kBudget = 100;
  MemoryBudget budget(kBudget);
  std::atomic<std::uint64_t> taken = 0;
  std::atomic<bool> is_exceeded = false;
  std::vector<std::thread> threads;
  for (std::uint64_t share : {100U, 60U, 50U, 30U}) {
    threads.emplace_back([&, share] {
      for (int i = 0; i < 1000; ++i) {
        const auto part = budget.Take("a", share);
        if ((taken += share) > kBudget) is_exceeded = true;
        taken -= share;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_FALSE(is_exceeded);
}

TEST(MemoryBudget, RefusesWhatNeverFits) {
  MemoryBudget budget(std::uint64_t{1} << 30);
  try {
    budget.Take("huge.c3d", std::uint64_t{2} << 30);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("huge.c3d: may need 2 GiB of memory, more than the "
                                     "1 GiB allowed"));
  }
}

}  // namespace
}  // namespace mmm_converter
