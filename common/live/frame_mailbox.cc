// SPDX-License-Identifier: MIT
#include "common/live/frame_mailbox.h"

namespace mmm_converter {

void FrameMailbox::Put() {
  const int before = waiting_.exchange(writing_ + kFresh, std::memory_order_acq_rel);
  writing_ = before % kFresh;
  if (before >= kFresh) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
  } else {
    filled_.release();
  }
  if (!keeps_all_) return;
  while (!stopped_.load(std::memory_order_acquire) &&
         waiting_.load(std::memory_order_acquire) >= kFresh) {
    (void)taken_.try_acquire_for(std::chrono::milliseconds(100));
  }
}

void FrameMailbox::Close() {
  closed_.store(true, std::memory_order_release);
  filled_.release();
}

const LaidOutFrame* FrameMailbox::Take(std::chrono::milliseconds wait) {
  if (waiting_.load(std::memory_order_acquire) < kFresh) {
    if (is_closed()) return nullptr;
    (void)filled_.try_acquire_for(wait);
    if (waiting_.load(std::memory_order_acquire) < kFresh) return nullptr;
  } else {
    (void)filled_.try_acquire();
  }
  reading_ = waiting_.exchange(reading_, std::memory_order_acq_rel) % kFresh;
  if (keeps_all_) taken_.release();
  return &slots_[reading_];
}

void FrameMailbox::StopWaiting() {
  stopped_.store(true, std::memory_order_release);
  taken_.release();
}

}  // namespace mmm_converter
