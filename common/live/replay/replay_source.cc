// SPDX-License-Identifier: MIT
#include "common/live/replay/replay_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

// [s] Between a loop's last frame and the next one's first: nobody moves from one to the other, so
// that it is a gap in the motion. Shorter than what StreamClock takes for another clock.
constexpr double kLoopGap = 0.5;

}  // namespace

ReplaySource::ReplaySource(MarkerSequence recording, long first_number, PlaybackOptions options,
                           const std::string& name)
    : recording_(std::move(recording)),
      first_number_(first_number),
      playback_(recording_.num_frames(), recording_.rate(), std::move(options)),
      layout_{name, recording_.labels(), recording_.rate()},
      message_(fmt::format("{} ended", name)) {
  counts_.connections = 1;
}

StreamEvent ReplaySource::Next(std::chrono::milliseconds wait, StreamFrame* frame) {
  if (!has_begun_) {
    has_begun_ = true;
    playback_.Start();
    return StreamEvent::kLayout;
  }
  if (playback_.options().loop && playback_.taken() == begun_ + recording_.num_frames() &&
      playback_.is_running()) {
    begun_ = playback_.taken();
    return StreamEvent::kLayout;
  }
  auto number = playback_.Take();
  if (!number && playback_.is_running()) {
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(playback_.UntilNext(), wait));
    number = playback_.Take();
  }
  if (!number) return playback_.is_running() ? StreamEvent::kNothing : StreamEvent::kEnd;
  const int k = playback_.FrameOf(*number);
  frame->number = first_number_ + *number;
  const std::int64_t loops = *number / recording_.num_frames();
  frame->time = recording_.time(k) + static_cast<double>(*number - k) / recording_.rate() +
                kLoopGap * static_cast<double>(loops);
  frame->received = std::chrono::steady_clock::now();
  frame->points = recording_.frame(k);
  frame->unnamed = 0;
  ++counts_.frames;
  return StreamEvent::kFrame;
}

ReplayAddress ParseReplayAddress(const std::string& text) {
  const std::size_t at = text.rfind('@');
  std::error_code failure;
  if (at == std::string::npos || std::filesystem::exists(text, failure)) return {text, 1};
  const std::string speed = text.substr(at + 1);
  const std::string file = text.substr(0, at);
  if (speed == "max") return {file, 0};
  const auto number = ParseDouble(speed);
  if (!number || !(*number > 0)) {
    throw Error(fmt::format(
        "replay:{}: the speed after @ is a number above 0 or \"max\", not \"{}\"", text, speed));
  }
  return {file, *number};
}

}  // namespace mmm_converter
