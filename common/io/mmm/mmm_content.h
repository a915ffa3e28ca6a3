// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// The motion options.motion, or the one with most markers.
/// @throws Error as ReadMmmMotionFile; no such motion, one without markers, or several and none
/// chosen: the message lists them.
RecordingContent ReadMmmContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);

/// All motions, in the file's order; those without markers have no labels.
/// @throws Error as ReadMmmMotionFile.
std::vector<RecordingContent> ReadAllMmmContents(const std::string& file, Warnings* warnings);

}  // namespace mmm_converter
