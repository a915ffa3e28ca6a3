// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/motion/recording_content.h"
#include "common/support/warnings.h"

namespace mmm_converter {

// Tables of markers, each as its reader has it. They throw Error as ReadFileContent and that
// reader.

RecordingContent ReadTrcContent(const std::string& file, const ContentOptions& options,
                                Warnings* warnings);
RecordingContent ReadNexusCsvContent(const std::string& file, const ContentOptions& options,
                                     Warnings* warnings);
RecordingContent ReadMotiveCsvContent(const std::string& file, const ContentOptions& options,
                                      Warnings* warnings);
RecordingContent ReadQtmTsvContent(const std::string& file, const ContentOptions& options,
                                   Warnings* warnings);

RecordingContent ReadPointsCsvContent(const std::string& file, const ContentOptions& options,
                                      Warnings* warnings);

}  // namespace mmm_converter
