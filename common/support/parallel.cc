// SPDX-License-Identifier: MIT
#include "common/support/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

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
  arena.execute([&] {
    const oneapi::tbb::blocked_range<int> all(0, count, 1);
    oneapi::tbb::parallel_for(
        all,
        [&](const oneapi::tbb::blocked_range<int>& range) {
          for (int i = range.begin(); i < range.end(); ++i) body(i);
        },
        oneapi::tbb::simple_partitioner());
  });
}

}  // namespace mmm_converter
