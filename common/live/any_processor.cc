// SPDX-License-Identifier: MIT
#include "common/live/any_processor.h"

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

namespace mmm_converter {

void UseAnyProcessor() {
  cpu_set_t set;
  if (::sched_getaffinity(::getpid(), sizeof set, &set) != 0) return;
  (void)::pthread_setaffinity_np(::pthread_self(), sizeof set, &set);
}

}  // namespace mmm_converter
