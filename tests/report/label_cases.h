// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/pipeline/recording_labels.h"

namespace mmm_converter::testing {

/// Three points in 60 frames: two are exchanged in frames 20 to 39, of which the second is called
/// `text`; the third has no label and takes over from the first at frame 50. A repair where text is
/// RKNE.
LabelReport LabelCase(const std::string& text);

}  // namespace mmm_converter::testing
