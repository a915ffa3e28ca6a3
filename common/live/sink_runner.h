// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "common/live/latency_histogram.h"
#include "common/live/pose_sink.h"

namespace mmm_converter {

/// Gives frames to a sink on a thread of its own: whoever offers them never waits for the sink. A
/// sink that is slow loses frames, one that fails gets no more.
class SinkRunner {
 public:
  /// capacity: frames that may wait. on_failure is called once, on the sink's thread.
  SinkRunner(std::unique_ptr<PoseSink> sink, int capacity,
             std::function<void(const std::string&)> on_failure);
  ~SinkRunner();
  SinkRunner(const SinkRunner&) = delete;
  SinkRunner& operator=(const SinkRunner&) = delete;

  /// Copies the frame; allocates nothing once frames have their size. may_wait: where the sink
  /// needs every frame, waits until there is room.
  void Offer(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame, bool may_wait);

  /// Writes what waits, ends the sink and its thread.
  void Finish();

  PoseSink& sink() { return *sink_; }
  std::int64_t lost() const { return lost_; }  ///< frames for which there was no room
  bool has_failed() const { return failed_.load(std::memory_order_acquire); }
  // After Finish:
  std::int64_t written() const { return delays_.count(); }
  const LatencyHistogram& delays() const { return delays_; }  ///< from received to written

 private:
  struct Slot {
    std::shared_ptr<const LiveBody> body;
    PoseFrame frame;
  };

  void Run();
  void WriteWaiting();
  template <typename Step>
  void Try(Step step);

  std::unique_ptr<PoseSink> sink_;
  std::function<void(const std::string&)> on_failure_;
  std::vector<Slot> slots_;
  std::atomic<std::size_t> offered_ = 0, taken_ = 0;
  std::atomic<bool> ending_ = false, failed_ = false;
  std::counting_semaphore<1 << 20> filled_{0};
  std::int64_t lost_ = 0;
  LatencyHistogram delays_;
  std::thread thread_;
};

}  // namespace mmm_converter
