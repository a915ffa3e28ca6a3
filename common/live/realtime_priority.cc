// SPDX-License-Identifier: MIT
#include "common/live/realtime_priority.h"

#include <sched.h>

namespace mmm_converter {

RealtimePriority::RealtimePriority(int priority, bool for_children) {
  if (priority == 0) return;
  sched_param wanted{};
  wanted.sched_priority = priority;
  const int policy = SCHED_FIFO | (for_children ? 0 : SCHED_RESET_ON_FORK);
  is_given_ = ::sched_setscheduler(0, policy, &wanted) == 0;
}

RealtimePriority::~RealtimePriority() {
  const sched_param usual{};
  if (is_given_) ::sched_setscheduler(0, SCHED_OTHER, &usual);
}

}  // namespace mmm_converter
