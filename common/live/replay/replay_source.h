// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "common/live/frame_source.h"
#include "common/motion/marker_sequence.h"

namespace mmm_converter {

/// How a recording is played.
struct Replay {
  double speed = 1;  ///< 2: twice as fast as it was recorded; 0: as fast as its frames are taken
  bool loops = false;
};

/// A recording as a stream: frame k has the number first_number + k and the recording's time. A
/// loop begins with a layout, and its frames count on.
class ReplaySource : public FrameSource {
 public:
  /// name: for messages.
  ReplaySource(MarkerSequence recording, long first_number, const Replay& replay,
               const std::string& name);

  StreamEvent Next(std::chrono::milliseconds wait, StreamFrame* frame) override;
  const StreamLayout& layout() const override { return layout_; }
  const std::string& message() const override { return message_; }
  const StreamCounts& counts() const override { return counts_; }
  bool waits_for_reader() const override { return replay_.speed == 0; }

 private:
  StreamEvent EndOrBeginAgain();

  MarkerSequence recording_;
  long first_number_;
  Replay replay_;
  StreamLayout layout_;
  std::string message_;
  StreamCounts counts_;
  bool has_begun_ = false;
  int next_ = 0;
  int rounds_ = 0;
  SteadyTime start_;  // when the first frame of this round was due
};

/// "FILE@2", "FILE@max", "FILE": the file's name, and how it is played.
struct ReplayAddress {
  std::string file;
  double speed = 1;
};
/// @throws Error where what follows the last @ is neither a number above 0 nor "max", and no file
/// has the whole name.
ReplayAddress ParseReplayAddress(const std::string& text);

/// A recording that is read as its file states it, by what stands behind "replay:".
/// @throws Error as ParseReplayAddress and ReadRecording.
std::unique_ptr<FrameSource> OpenReplay(const std::string& address);

}  // namespace mmm_converter
