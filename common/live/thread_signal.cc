// SPDX-License-Identifier: MIT
#include "common/live/thread_signal.h"

#include <semaphore.h>

#include <cerrno>
#include <cstdint>
#include <ctime>

namespace mmm_converter {

struct ThreadSignal::Semaphore {
  Semaphore() { ::sem_init(&value, 0, 0); }
  ~Semaphore() { ::sem_destroy(&value); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  sem_t value{};
};

ThreadSignal::ThreadSignal() : semaphore_(std::make_unique<Semaphore>()) {}
ThreadSignal::~ThreadSignal() = default;

void ThreadSignal::Give() {
  if (!is_given_.exchange(true, std::memory_order_acq_rel)) ::sem_post(&semaphore_->value);
}

bool ThreadSignal::Take(std::chrono::nanoseconds wait) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  timespec until{};
  ::clock_gettime(CLOCK_MONOTONIC, &until);
  const std::int64_t end = until.tv_nsec + wait.count();
  until.tv_sec += end / kSecond;
  until.tv_nsec = end % kSecond;
  while (::sem_clockwait(&semaphore_->value, CLOCK_MONOTONIC, &until) != 0) {
    if (errno != EINTR) return false;
  }
  is_given_.exchange(false, std::memory_order_acq_rel);
  return true;
}

}  // namespace mmm_converter
