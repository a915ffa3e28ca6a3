// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

/// True if a file that starts like this can be a C3D file.
bool LooksLikeC3d(std::string_view start);

/// Points are read from the file when they are chosen. @throws Error as C3dReader.
RecordingContent ReadC3dContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);

}  // namespace mmm_converter
