// SPDX-License-Identifier: MIT
#include "common/live/frame_mailbox.h"

#include <algorithm>

namespace mmm_converter {

FrameMailbox::FrameMailbox(bool keeps_all) : keeps_all_(keeps_all) {
  for (int i = 0; i < kRoom; ++i) waiting_[static_cast<std::size_t>(i)] = i;
}

void FrameMailbox::Put() {
  const std::int64_t order = written_.load(std::memory_order_relaxed);
  std::atomic<int>& place = waiting_[static_cast<std::size_t>(order % kRoom)];
  slots_[static_cast<std::size_t>(writing_)].order = order;
  writing_ = place.exchange(writing_, std::memory_order_acq_rel);
  written_.store(order + 1, std::memory_order_release);
  filled_.Give();
  if (!keeps_all_) return;
  while (!stopped_.load(std::memory_order_acquire) &&
         next_.load(std::memory_order_acquire) <= order) {
    (void)emptied_.Take(std::chrono::milliseconds(100));
  }
}

void FrameMailbox::Close() {
  closed_.store(true, std::memory_order_release);
  filled_.Give();
}

const LaidOutFrame* FrameMailbox::Take(std::chrono::nanoseconds wait, int most) {
  const SteadyTime end = std::chrono::steady_clock::now() + wait;
  while (true) {
    const bool is_last_look = is_closed();
    if (!is_empty()) break;
    const std::chrono::nanoseconds left = end - std::chrono::steady_clock::now();
    if (is_last_look || left.count() <= 0 || !filled_.Take(left)) return nullptr;
  }
  const std::int64_t written = written_.load(std::memory_order_acquire);
  const std::int64_t expected = next_.load(std::memory_order_relaxed);
  std::int64_t next = std::max(expected, written - kRoom);
  const bool takes_newest = written - next > most;
  do {
    std::atomic<int>& place = waiting_[static_cast<std::size_t>(next % kRoom)];
    reading_ = place.exchange(reading_, std::memory_order_acq_rel);
    // A later one than `next`, where the writer has just come round.
    next = slots_[static_cast<std::size_t>(reading_)].order + 1;
  } while (takes_newest && next < written);
  dropped_.fetch_add(next - expected - 1, std::memory_order_relaxed);
  next_.store(next, std::memory_order_release);
  if (keeps_all_) emptied_.Give();
  return &slots_[static_cast<std::size_t>(reading_)].frame;
}

void FrameMailbox::StopWaiting() {
  stopped_.store(true, std::memory_order_release);
  emptied_.Give();
}

}  // namespace mmm_converter
