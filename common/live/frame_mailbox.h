// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <semaphore>

#include "common/live/frame_source.h"

namespace mmm_converter {

/// A frame with the layout that it has.
struct LaidOutFrame {
  StreamFrame frame;
  std::shared_ptr<const StreamLayout> layout;
  StreamCounts counts;  ///< of the source, until this frame
};

/// Between the thread that reads a source and the one that tracks: a queue of one in which the
/// newest frame wins. Neither waits for a lock of the other.
class FrameMailbox {
 public:
  /// keeps_all: Put waits until the last frame is taken, so that none is dropped.
  explicit FrameMailbox(bool keeps_all) : keeps_all_(keeps_all) {}

  // For the reading thread.
  LaidOutFrame& next() { return slots_[writing_]; }  ///< to be filled before Put
  void Put();                                        ///< next() is there to be taken
  void Close();                                      ///< nothing will come any more

  // For the tracking thread.
  /// The newest frame that was not taken yet, valid until the next call; null: none came in time,
  /// or the box is closed and empty.
  const LaidOutFrame* Take(std::chrono::milliseconds wait);
  bool is_closed() const { return closed_.load(std::memory_order_acquire); }
  /// Puts that would wait go on, and are lost.
  void StopWaiting();

  /// Frames that a newer one took the place of.
  std::int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static constexpr int kFresh = 4;  // added to the index of a slot that nobody has taken yet

  bool keeps_all_;
  std::array<LaidOutFrame, 3> slots_;
  int writing_ = 0;
  int reading_ = 1;
  std::atomic<int> waiting_ = 2;
  std::atomic<bool> closed_ = false;
  std::atomic<bool> stopped_ = false;
  std::atomic<std::int64_t> dropped_ = 0;
  std::counting_semaphore<1 << 20> filled_{0};
  std::counting_semaphore<1 << 20> taken_{0};
};

}  // namespace mmm_converter
