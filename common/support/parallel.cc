// SPDX-License-Identifier: MIT
#include "common/support/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <cstddef>

#include "common/support/machine.h"

namespace mmm_converter {

int DefaultJobs() { return AvailableCores(); }

void ParallelFor(int count, int jobs, const std::function<void(int)>& body) {
  if (jobs == 0) jobs = DefaultJobs();
  if (jobs == 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(jobs));
  oneapi::tbb::task_arena arena(jobs);
  // Bodies see what was written before the loop, and the caller what they wrote. TBB sees to that;
  // for the thread sanitizer, which does not see into TBB, it is said once more.
  std::atomic<int> ended = 0;
  std::atomic<bool> begun = false;
  begun.store(true, std::memory_order_release);
  arena.execute([&] {
    const oneapi::tbb::blocked_range<int> all(0, count, 1);
    oneapi::tbb::parallel_for(
        all,
        [&](const oneapi::tbb::blocked_range<int>& range) {
          begun.load(std::memory_order_acquire);
          for (int i = range.begin(); i < range.end(); ++i) body(i);
          ended.fetch_add(1, std::memory_order_release);
        },
        oneapi::tbb::simple_partitioner());
  });
  ended.load(std::memory_order_acquire);
}

}  // namespace mmm_converter
