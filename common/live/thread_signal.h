// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <memory>

namespace mmm_converter {

/// Wakes one thread that waits. A wait of std::counting_semaphore with a time limit is no
/// substitute: GCC's sleeps in growing steps, and so ends up to half as late again as it should.
class ThreadSignal {
 public:
  ThreadSignal();
  ~ThreadSignal();
  ThreadSignal(const ThreadSignal&) = delete;
  ThreadSignal& operator=(const ThreadSignal&) = delete;

  /// Given more than once before it is taken, it is taken once.
  void Give();
  /// False: it was not given in time.
  bool Take(std::chrono::nanoseconds wait);

 private:
  struct Semaphore;
  std::unique_ptr<Semaphore> semaphore_;
  std::atomic<bool> is_given_ = false;
};

}  // namespace mmm_converter
