// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/live/pose_frame.h"

namespace mmm_converter {

/// What a WebSocket client gets of a body before its postures (../README.md).
std::string FormatBody(const LiveBody& body);

/// One posture. with_segments: with the pose of every segment too.
std::string FormatPosture(const LiveBody& body, const PoseFrame& frame, SteadyTime now,
                          bool with_segments);

}  // namespace mmm_converter
