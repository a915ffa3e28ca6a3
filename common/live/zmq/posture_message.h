// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/live/pose_frame.h"

namespace mmm_converter {

/// The parts of a message behind its topic (common/live/README.md): a header, which is JSON, and
/// the bytes of its arrays, little endian.
struct PostureMessage {
  std::string header;
  std::string arrays;
};

/// What all messages of a body have alike.
class PostureMessageFormat {
 public:
  explicit PostureMessageFormat(const LiveBody& body);

  /// now: when it is sent.
  PostureMessage Format(const LiveBody& body, const PoseFrame& frame, SteadyTime now) const;

 private:
  std::string fixed_;  // of the header: names and fields
};

}  // namespace mmm_converter
