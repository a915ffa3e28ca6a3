// SPDX-License-Identifier: MIT
#include "common/live/frame_source.h"

namespace mmm_converter {

FrameSource::~FrameSource() = default;

}  // namespace mmm_converter
