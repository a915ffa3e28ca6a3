// SPDX-License-Identifier: MIT
#include "common/live/playback/playback.h"

#include <algorithm>
#include <utility>

namespace mmm_converter {
namespace {

constexpr std::chrono::nanoseconds kLongestPause = std::chrono::seconds(1);

}  // namespace

Playback::Playback(int num_frames, double rate, PlaybackOptions options)
    : num_frames_(num_frames), rate_(rate), options_(std::move(options)) {}

void Playback::Start() {
  is_running_ = num_frames_ > 0;
  has_ended_ = !is_running_;
  start_ = options_.now();
  // A recording that is played again begins at its first frame, its numbers go on.
  taken_ = (taken_ + num_frames_ - 1) / std::max<std::int64_t>(num_frames_, 1) * num_frames_;
  first_ = taken_;
}

SteadyTime Playback::DueTime() const {
  const std::chrono::duration<double> after(static_cast<double>(taken_ - first_) /
                                            (rate_ * options_.speed));
  return start_ + std::chrono::duration_cast<SteadyTime::duration>(after);
}

std::optional<std::int64_t> Playback::Take() {
  if (!is_running_) return std::nullopt;
  if (!options_.loop && taken_ - first_ == num_frames_) {
    is_running_ = false;
    has_ended_ = true;
    return std::nullopt;
  }
  if (options_.speed > 0 && DueTime() > options_.now()) return std::nullopt;
  return taken_++;
}

std::chrono::nanoseconds Playback::UntilNext() const {
  using std::chrono::nanoseconds;
  if (!is_running_) return kLongestPause;
  if (options_.speed == 0) return nanoseconds(0);
  return std::clamp<nanoseconds>(DueTime() - options_.now(), nanoseconds(0), kLongestPause);
}

}  // namespace mmm_converter
