// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/live/frame_source.h"
#include "common/live/playback/playback.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// A recording as a stream: frame k has the number first_number + k and the recording's time. A
/// loop begins with a layout, half a second later, and its frames count on.
class ReplaySource : public FrameSource {
 public:
  /// name: for messages.
  ReplaySource(MarkerSequence recording, long first_number, PlaybackOptions options,
               const std::string& name);

  StreamEvent Next(std::chrono::milliseconds wait, StreamFrame* frame) override;
  const StreamLayout& layout() const override { return layout_; }
  const std::string& message() const override { return message_; }
  const StreamCounts& counts() const override { return counts_; }
  bool waits_for_reader() const override { return playback_.options().speed == 0; }

 private:
  MarkerSequence recording_;
  long first_number_;
  Playback playback_;
  StreamLayout layout_;
  std::string message_;
  StreamCounts counts_;
  bool has_begun_ = false;
  std::int64_t begun_ = 0;  // the first frame of this round
};

/// "FILE@2", "FILE@max", "FILE": the file's name, and how it is played.
struct ReplayAddress {
  std::string file;
  double speed = 1;
};
/// @throws Error where what follows the last @ is neither a number above 0 nor "max", and no file
/// has the whole name.
ReplayAddress ParseReplayAddress(const std::string& text);

}  // namespace mmm_converter
