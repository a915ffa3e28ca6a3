// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// @throws Error as ReadFileContent and ParseTrc.
RecordingContent ReadTrcContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);

}  // namespace mmm_converter
