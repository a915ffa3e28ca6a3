// SPDX-License-Identifier: MIT
#include "common/live/frame_source.h"

#include <algorithm>

namespace mmm_converter {

FrameSource::~FrameSource() = default;

void SetUnnamed(std::size_t count, StreamFrame* frame) {
  frame->unnamed = static_cast<int>(std::min<std::size_t>(count, kMostUnnamed));
  if (frame->unnamed_points.cols() >= frame->unnamed) return;
  frame->unnamed_points.resize(3, std::min(std::max(2 * frame->unnamed, 64), kMostUnnamed));
}

}  // namespace mmm_converter
