// SPDX-License-Identifier: MIT
#include "common/live/connected_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::chrono::milliseconds kFirstRetry{500};
constexpr std::chrono::milliseconds kLongestRetry{8000};
constexpr std::int64_t kMostLostAtOnce = 1000000;  // else the numbers begin anew
constexpr std::int64_t kMostLate = 1000;
// Of a layout: each costs memory in every frame that is kept.
constexpr std::size_t kMostLabels = 2000;

}  // namespace

ConnectedSource::ConnectedSource(std::function<SteadyTime()> now)
    : now_(std::move(now)), retry_at_(now_()), retry_wait_(kFirstRetry) {}

StreamEvent ConnectedSource::Next(std::chrono::milliseconds wait, StreamFrame* frame) {
  const SteadyTime end = std::chrono::steady_clock::now() + wait;
  while (true) {
    if (frame_is_pending_) {
      frame_is_pending_ = false;
      if (const Event event = FillFrame(frame)) return *event;
    }
    if (!is_connected_ && now_() >= retry_at_) {
      is_connected_ = true;
      if (const Event event = Connect()) return *event;
    }
    if (is_connected_) {
      if (const Event event = Advance(frame)) return *event;
    }
    const SteadyTime::duration left = end - std::chrono::steady_clock::now();
    if (left.count() <= 0) return StreamEvent::kNothing;
    Wait(is_connected_ ? left : std::min(left, retry_at_ - now_()));
  }
}

void ConnectedSource::CountConnection() {
  ++counts_.connections;
  last_number_ = -1;
}

StreamEvent ConnectedSource::CountFrame(std::int64_t number) {
  const std::int64_t gap = number - last_number_ - 1;
  if (last_number_ >= 0 && gap > 0 && gap < kMostLostAtOnce) counts_.lost += gap;
  if (gap >= 0 || gap < -kMostLate) last_number_ = number;
  ++counts_.frames;
  return StreamEvent::kFrame;
}

ConnectedSource::Event ConnectedSource::Lose(const std::string& reason, const std::string& remedy) {
  const std::string whole =
      fmt::format("{}: {}{}{}", Server(), reason, remedy.empty() ? "" : "; ", remedy);
  ConnectAnew();
  if (!had_layout_) throw Error(whole);
  retry_at_ = now_() + retry_wait_;
  retry_wait_ = std::min(2 * retry_wait_, kLongestRetry);
  return Say(whole);
}

ConnectedSource::Event ConnectedSource::Say(const std::string& reason) {
  if (is_lost_) return std::nullopt;
  is_lost_ = layout_is_due_ = true;
  message_ = reason;
  return StreamEvent::kLost;
}

void ConnectedSource::ConnectAnew() {
  Disconnect();
  is_connected_ = false;
  retry_at_ = now_();
}

ConnectedSource::Event ConnectedSource::TakeLayout(StreamLayout layout) {
  if (layout.labels.size() > kMostLabels) {
    return Lose(fmt::format("it has {} labelled markers, and at most {} are taken",
                            layout.labels.size(), kMostLabels),
                "stream those of the person only");
  }
  const bool is_new = !had_layout_ || layout.labels != layout_.labels ||
                      layout.rate != layout_.rate || layout.source != layout_.source;
  layout_ = std::move(layout);
  if (!is_new || is_lost_) return std::nullopt;
  had_layout_ = true;
  return StreamEvent::kLayout;
}

ConnectedSource::Event ConnectedSource::FrameCame(StreamFrame* frame) {
  is_lost_ = false;
  retry_wait_ = kFirstRetry;
  if (!layout_is_due_) return FillFrame(frame);
  layout_is_due_ = false;
  frame_is_pending_ = true;
  return StreamEvent::kLayout;
}

}  // namespace mmm_converter
