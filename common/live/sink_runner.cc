// SPDX-License-Identifier: MIT
#include "common/live/sink_runner.h"

#include <chrono>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {

PoseSink::~PoseSink() = default;

SinkRunner::SinkRunner(std::unique_ptr<PoseSink> sink, int capacity,
                       std::function<void(const std::string&)> on_failure)
    : sink_(std::move(sink)),
      on_failure_(std::move(on_failure)),
      slots_(static_cast<std::size_t>(capacity)),
      thread_([this] { Run(); }) {}

SinkRunner::~SinkRunner() { Finish(); }

void SinkRunner::Offer(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame,
                       bool may_wait) {
  const std::size_t offered = offered_.load(std::memory_order_relaxed);
  const auto is_full = [&] {
    return offered - taken_.load(std::memory_order_acquire) == slots_.size();
  };
  while (may_wait && sink_->needs_every_frame() && !has_failed() && is_full()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (has_failed()) return;
  if (is_full()) {
    ++lost_;
    return;
  }
  Slot& slot = slots_[offered % slots_.size()];
  slot.body = body;
  slot.frame = frame;
  offered_.store(offered + 1, std::memory_order_release);
  filled_.release();
}

void SinkRunner::Finish() {
  if (!thread_.joinable()) return;
  ending_.store(true, std::memory_order_release);
  filled_.release();
  thread_.join();
}

void SinkRunner::Run() {
  while (!ending_.load(std::memory_order_acquire)) {
    filled_.acquire();
    WriteWaiting();
  }
  WriteWaiting();
  if (!has_failed()) Try([this] { sink_->End(); });
}

void SinkRunner::WriteWaiting() {
  std::size_t taken = taken_.load(std::memory_order_relaxed);
  for (; taken != offered_.load(std::memory_order_acquire);
       taken_.store(++taken, std::memory_order_release)) {
    if (has_failed()) continue;
    const Slot& slot = slots_[taken % slots_.size()];
    Try([&] {
      sink_->Write(slot.body, slot.frame);
      const auto now = std::chrono::steady_clock::now();
      delays_.Add(std::chrono::duration<double>(now - slot.frame.received).count());
    });
  }
}

template <typename Step>
void SinkRunner::Try(Step step) {
  try {
    step();
  } catch (const std::exception& error) {
    failed_.store(true, std::memory_order_release);
    if (on_failure_) on_failure_(error.what());
  }
}

}  // namespace mmm_converter
