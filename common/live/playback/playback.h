// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "common/live/frame_source.h"

namespace mmm_converter {

struct PlaybackOptions {
  double speed = 1;  ///< of the recording's; 0: as fast as the frames are taken
  bool loop = false;
  /// The time; for tests another than the system's.
  std::function<SteadyTime()> now = [] { return std::chrono::steady_clock::now(); };
};

/// Which frame of a recording that is played is due when.
class Playback {
 public:
  Playback(int num_frames, double rate, PlaybackOptions options);

  /// From the first frame on.
  void Start();
  bool is_running() const { return is_running_; }
  bool has_ended() const { return has_ended_; }  ///< since the last Start

  /// The running number of the next frame, from 0 on, if it is due; it is then taken. Goes on over
  /// the recording's end where it is played in a loop.
  std::optional<std::int64_t> Take();
  /// Frames that were taken since the first Start.
  std::int64_t taken() const { return taken_; }
  /// Of a running number, in the recording.
  int FrameOf(std::int64_t number) const { return static_cast<int>(number % num_frames_); }
  /// How long until the next frame is due, a second at most; 0: now.
  std::chrono::nanoseconds UntilNext() const;
  const PlaybackOptions& options() const { return options_; }

 private:
  SteadyTime DueTime() const;

  std::int64_t num_frames_;
  double rate_;
  PlaybackOptions options_;
  bool is_running_ = false, has_ended_ = false;
  SteadyTime start_;
  std::int64_t taken_ = 0, first_ = 0;  // of this Start
};

}  // namespace mmm_converter
