// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/live/pose_frame.h"

namespace mmm_converter {

/// What a WebSocket client gets of a body before its postures (../README.md).
std::string FormatBody(const LiveBody& body);

/// What postures are written with beyond themselves.
struct PostureDetails {
  bool with_segments = false;  ///< the pose of every segment
  bool with_anatomy = false;   ///< angles by their anatomical names [rad], of a person
};

/// One posture.
std::string FormatPosture(const LiveBody& body, const PoseFrame& frame, SteadyTime now,
                          const PostureDetails& details);

}  // namespace mmm_converter
