// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/live/pose_frame.h"

namespace mmm_converter {

/// Where postures go: a file, a network. For one thread, which is its own.
class PoseSink {
 public:
  virtual ~PoseSink();

  virtual std::string name() const = 0;  ///< for messages, as the user gave it

  /// The body may be another one than that of the frame before; it stays valid as long as the sink.
  /// @throws Error where nothing can be sent or written any more.
  virtual void Write(const std::shared_ptr<const LiveBody>& body, const PoseFrame& frame) = 0;

  /// No frame will follow. @throws Error
  virtual void End() {}

  /// Whether a source that can wait should wait until each frame has been written.
  virtual bool needs_every_frame() const { return false; }
};

}  // namespace mmm_converter
