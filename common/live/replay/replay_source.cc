// SPDX-License-Identifier: MIT
#include "common/live/replay/replay_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>

#include "common/io/recording/recording.h"
#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::steady_clock;

ReplaySource::ReplaySource(MarkerSequence recording, long first_number, const Replay& replay,
                           const std::string& name)
    : recording_(std::move(recording)), first_number_(first_number), replay_(replay) {
  layout_ = {name, recording_.labels(), recording_.rate()};
  message_ = fmt::format("{} ended", name);
  counts_.connections = 1;
}

StreamEvent ReplaySource::EndOrBeginAgain() {
  if (!replay_.loops) return StreamEvent::kEnd;
  next_ = 0;
  ++rounds_;
  start_ = steady_clock::now();
  return StreamEvent::kLayout;
}

StreamEvent ReplaySource::Next(std::chrono::milliseconds wait, StreamFrame* frame) {
  if (!has_begun_) {
    has_begun_ = true;
    start_ = steady_clock::now();
    return StreamEvent::kLayout;
  }
  if (next_ == recording_.num_frames()) return EndOrBeginAgain();
  if (replay_.speed > 0) {
    const duration<double> due(next_ / (recording_.rate() * replay_.speed));
    const SteadyTime when = start_ + duration_cast<steady_clock::duration>(due);
    const SteadyTime until = steady_clock::now() + wait;
    std::this_thread::sleep_until(std::min(when, until));
    if (until < when) return StreamEvent::kNothing;
  }
  const std::int64_t passed = std::int64_t{rounds_} * recording_.num_frames();
  frame->number = first_number_ + passed + next_;
  frame->time = recording_.time(next_) + static_cast<double>(passed) / recording_.rate();
  frame->received = steady_clock::now();
  frame->points = recording_.frame(next_);
  frame->unnamed = 0;
  ++next_;
  ++counts_.frames;
  return StreamEvent::kFrame;
}

ReplayAddress ParseReplayAddress(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || std::filesystem::exists(text)) return {text, 1};
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

std::unique_ptr<FrameSource> OpenReplay(const std::string& address) {
  const ReplayAddress parsed = ParseReplayAddress(address);
  Recording recording = ReadRecording(parsed.file, {});
  return std::make_unique<ReplaySource>(std::move(recording.markers), recording.first_frame,
                                        Replay{parsed.speed, false}, parsed.file);
}

}  // namespace mmm_converter
