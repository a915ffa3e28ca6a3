// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>

#include "common/live/frame_source.h"
#include "common/live/thread_signal.h"

namespace mmm_converter {

/// A frame with the layout that it has.
struct LaidOutFrame {
  StreamFrame frame;
  std::shared_ptr<const StreamLayout> layout;
  StreamCounts counts;  ///< of the source, until this frame
};

/// Between the thread that reads a source and the one that tracks. Where more frames wait than the
/// tracker can afford to take in order, the newest wins. Neither thread waits for a lock of the
/// other.
class FrameMailbox {
 public:
  static constexpr int kRoom = 256;  ///< frames that may wait; the oldest gives way

  /// keeps_all: Put waits until the last frame is taken, so that none is dropped.
  explicit FrameMailbox(bool keeps_all);

  // For the reading thread.
  LaidOutFrame& next() { return slots_[writing_].frame; }  ///< to be filled before Put
  void Put();                                              ///< next() is there to be taken
  void Close();                                            ///< nothing will come any more

  // For the tracking thread.
  /// Of the frames that wait the oldest, where they are no more than `most`, otherwise the newest:
  /// then the others are dropped. It is valid until the next call; null: none came in time, or the
  /// box is closed and empty.
  const LaidOutFrame* Take(std::chrono::nanoseconds wait, int most);
  bool is_empty() const {
    return next_.load(std::memory_order_relaxed) >= written_.load(std::memory_order_acquire);
  }
  bool is_closed() const { return closed_.load(std::memory_order_acquire); }
  /// Puts that would wait go on.
  void StopWaiting();

  /// Frames that a newer one took the place of.
  std::int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    LaidOutFrame frame;
    std::int64_t order = 0;  // of Put
  };

  bool keeps_all_;
  std::array<Slot, kRoom + 2> slots_;
  // Each thread has a slot of its own, and exchanges it for one of these.
  std::array<std::atomic<int>, kRoom> waiting_;
  int writing_ = kRoom;
  int reading_ = kRoom + 1;
  std::atomic<std::int64_t> next_ = 0;  // to be taken
  std::atomic<std::int64_t> written_ = 0;
  std::atomic<bool> closed_ = false;
  std::atomic<bool> stopped_ = false;
  std::atomic<std::int64_t> dropped_ = 0;
  ThreadSignal filled_, emptied_;
};

}  // namespace mmm_converter
